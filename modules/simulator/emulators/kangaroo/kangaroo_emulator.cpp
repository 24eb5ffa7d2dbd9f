// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/emulators/kangaroo/kangaroo_emulator.hpp"

#include <algorithm>
#include <cmath>
#include <cstdlib>

namespace tread::sim {
namespace {

constexpr int kAddress = 128;
constexpr int64_t kControlPeriod = 5'000;  // [us]
constexpr double kGain = 0.02;             // power per period and 1 m/s of error

}  // namespace

// As a table of each of the 128 values' contributions: the driver computes the sum bit by bit.
int KangarooEmulator::sumOf(const std::string& packet) {
  int sum = 0x3fff;
  for (const char byte : packet) {
    int part = (sum ^ byte) & 0x7f;
    for (int bit = 0; bit < 7; ++bit) part = part % 2 == 1 ? part / 2 ^ 0x22f0 : part / 2;
    sum = sum / 128 ^ part;
  }
  return sum ^ 0x3fff;
}

MotorValues KangarooEmulator::output(int64_t utime) {
  advance(utime);
  return {channels_[0].power, channels_[1].power};
}

std::optional<MotorValues> KangarooEmulator::heldSpeeds() const {
  return MotorValues{channels_[0].speed / kUnitsPerMetre, channels_[1].speed / kUnitsPerMetre};
}

void KangarooEmulator::run(int64_t utime) {
  if (timeout_us_ > 0 && utime - heard_at_ >= timeout_us_)
    for (Channel& channel : channels_)
      if (channel.error == 0) stop(channel, 6);
  if (utime - controlled_at_ < kControlPeriod) return;
  controlled_at_ = utime;
  for (size_t i = 0; i < channels_.size(); ++i) {
    Channel& channel = channels_[i];
    const double error = channel.speed / kUnitsPerMetre - measured_[i];
    channel.power = std::clamp(channel.power + kGain * error, -1.0, 1.0);
    if (channel.speed == 0) channel.power = 0.0;
  }
}

void KangarooEmulator::powerUp(int64_t /*utime*/) {
  packet_.clear();
  channels_ = {};
  timeout_us_ = 0;
}

void KangarooEmulator::hear(char byte, int64_t utime) {
  const int value = static_cast<unsigned char>(byte);
  if (value >= 128) packet_.clear();
  if (packet_.empty() && value != kAddress) return;
  packet_ += byte;
  if (packet_.size() < 3 || packet_.size() < 5 + static_cast<size_t>(packet_[2])) return;
  const size_t end = packet_.size() - 2;
  if (sumOf(packet_.substr(0, end)) == packet_[end] + 128 * packet_[end + 1]) {
    heard_at_ = utime;
    execute(utime);
  } else {
    ++bad_sums_;
  }
  packet_.clear();
}

int KangarooEmulator::numberAt(size_t place) const {
  int64_t number = 0;
  int64_t weight = 1;
  for (size_t i = place; i < packet_.size() - 2 && weight < (int64_t{1} << 30); ++i, weight *= 64) {
    number += weight * (packet_[i] % 64);
    if (packet_[i] < 64) break;
  }
  return static_cast<int>(number % 2 == 1 ? -(number / 2) : number / 2);
}

void KangarooEmulator::execute(int64_t utime) {
  if (packet_[2] < 2 || (packet_[3] != '1' && packet_[3] != '2')) return;
  const auto index = static_cast<size_t>(packet_[3] - '1');
  Channel& channel = channels_[index];
  const bool more = packet_[2] >= 3;
  switch (packet_[1]) {
    case 0x20:
      if (channel.error != 0) channel = {0, 0, 0.0};
      return;
    case 0x23:
      if (more && packet_[5] == 2) tell(index, utime);
      return;
    case 0x24:
      if (more && packet_[5] == 2 && channel.error == 0) channel.speed = numberAt(6);
      return;
    case 0x25:
      if (more && packet_[5] == 33) timeout_us_ = std::max(0, numberAt(6)) * int64_t{62'500};
      return;
    default:
      return;
  }
}

void KangarooEmulator::tell(size_t channel, int64_t utime) {
  const int error = channels_[channel].error;
  const int64_t value = error > 0 ? error : std::llround(measured_[channel] * kUnitsPerMetre);
  std::string data{static_cast<char>('1' + channel), static_cast<char>(error > 0), 2};
  for (int64_t left = 2 * std::abs(value) + (value < 0);; left /= 64) {
    data += static_cast<char>(left % 64 + (left >= 64 ? 64 : 0));
    if (left < 64) break;
  }
  std::string packet{static_cast<char>(kAddress), 0x43, static_cast<char>(data.size())};
  packet += data;
  const int sum = sumOf(packet);
  packet += static_cast<char>(sum % 128);
  packet += static_cast<char>(sum / 128);
  reply(packet, utime);
}

}  // namespace tread::sim
