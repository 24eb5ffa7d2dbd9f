// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/emulators/sabertooth/sabertooth_emulator.hpp"

namespace tread::sim {
namespace {

constexpr int kAddress = 128;
constexpr int kBauding = 170;

}  // namespace

MotorValues SabertoothEmulator::output(int64_t utime) {
  advance(utime);
  return {power_[0] / 127.0, power_[1] / 127.0};
}

void SabertoothEmulator::run(int64_t utime) {
  if (timeout_us_ > 0 && utime - heard_at_ >= timeout_us_) power_ = {0, 0};
}

void SabertoothEmulator::powerUp(int64_t /*utime*/) {
  length_ = 0;
  bauded_ = false;
  power_ = {0, 0};
  timeout_us_ = 0;
}

void SabertoothEmulator::hear(char byte, int64_t utime) {
  const int value = static_cast<unsigned char>(byte);
  bauded_ = bauded_ || value == kBauding;
  if (!bauded_) return;
  // Only an address has its highest bit set, so it always begins a packet.
  if (value >= 128) length_ = 0;
  if (length_ == 0 && value != kAddress) return;
  packet_[static_cast<size_t>(length_++)] = value;
  if (length_ < 4) return;
  length_ = 0;
  if (((packet_[0] + packet_[1] + packet_[2]) & 127) != packet_[3]) {
    ++bad_sums_;
    return;
  }
  heard_at_ = utime;
  execute(packet_[1], packet_[2]);
}

void SabertoothEmulator::execute(int command, int value) {
  switch (command) {
    case 0:
    case 1:
      power_[0] = command == 0 ? value : -value;
      return;
    case 4:
    case 5:
      power_[1] = command == 4 ? value : -value;
      return;
    case 14:
      timeout_us_ = 100'000LL * value;
      return;
    default:
      return;
  }
}

}  // namespace tread::sim
