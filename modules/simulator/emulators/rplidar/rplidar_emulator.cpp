// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/emulators/rplidar/rplidar_emulator.hpp"

#include <algorithm>
#include <cmath>

namespace tread::sim {
namespace {

constexpr int kSamples = 360;

std::string sampleOf(bool start, double degrees, float range) {
  const bool seen = std::isfinite(range) && range < 16.0F;
  const auto angle = static_cast<unsigned>(std::lround(degrees * 64.0)) % (360U * 64U);
  const auto quarters = seen ? static_cast<unsigned>(std::lround(4000.0F * range)) : 0U;
  const unsigned quality = seen ? 47 : 0;
  std::string sample;
  for (const unsigned byte : {quality << 2 | (start ? 1U : 2U), (angle << 1 | 1U) & 0xffU,
                              angle >> 7, quarters & 0xffU, quarters >> 8})
    sample += static_cast<char>(byte);
  return sample;
}

}  // namespace

void RplidarEmulator::receive(std::string_view bytes, int64_t /*utime*/) {
  in_.append(bytes.substr(0, 4096));
  for (;;) {
    in_.erase(0, std::min(in_.find('\xA5'), in_.size()));
    if (in_.size() < 2) return;
    const char command = in_[1];
    // Commands from 80 on have a length, that many bytes, and a sum.
    size_t whole = 2;
    if (static_cast<unsigned char>(command) >= 0x80) {
      if (in_.size() < 3) return;
      whole = 4U + static_cast<unsigned char>(in_[2]);
      if (in_.size() < whole) return;
    }
    in_.erase(0, whole);
    if (!faults_.silent) run(command);
  }
}

void RplidarEmulator::run(char command) {
  const auto say = [&](const char* descriptor, const std::string& rest) {
    out_ += std::string(descriptor, 7) + rest;
  };
  switch (command) {
    case 0x25:
      scanning_ = false;
      samples_.clear();
      break;
    case 0x40:
      reboot();
      break;
    case 0x50:
      say("\xA5\x5A\x14\x00\x00\x00\x04",
          std::string("\x18\x1D\x01\x07", 4) + std::string(16, 'T'));
      break;
    case 0x52:
      say("\xA5\x5A\x03\x00\x00\x00\x06",
          std::string(1, faults_.ill ? 2 : 0) + std::string(2, '\0'));
      break;
    case 0x20:
      say("\xA5\x5A\x05\x00\x00\x40\x81", "");
      scanning_ = true;
      break;
    default:
      break;
  }
}

void RplidarEmulator::add(const LaserScan& scan) {
  if (!scanning_ || faults_.silent) return;
  const double step = laser_.field_of_view / (laser_.beams - 1);
  const int64_t finished = scan.utime + laser_.sweep_us;
  for (int i = 0; i < (faults_.half_turn ? kSamples / 2 : kSamples); ++i) {
    const double uncorrected = std::max(0.0, i + 0.3 * std::sin(i));
    const double degrees = uncorrected - faults_.correction;
    const double angle = -std::remainder(degrees * kPi / 180.0, 2.0 * kPi);
    const long beam = std::lround((angle + laser_.field_of_view / 2.0) / step);
    const bool seen = beam >= 0 && beam < static_cast<long>(scan.ranges.size());
    const float range = seen ? scan.ranges[static_cast<size_t>(beam)] : NAN;
    const bool echo = std::isfinite(range) && range < 16.0F;
    std::string sample =
        sampleOf(i == 0, std::fmod((echo ? degrees : uncorrected) + 360.0, 360.0), range);
    if (faults_.bad_check && i == 100) sample[0] = static_cast<char>(sample[0] ^ 1);
    if (faults_.dropped_byte && i == 100) sample.erase(3, 1);
    samples_.emplace_back(finished + laser_.period_us * i / kSamples, sample);
  }
}

std::string RplidarEmulator::transmit(int64_t utime) {
  std::string bytes = std::exchange(out_, {});
  for (; !samples_.empty() && samples_.front().first <= utime; samples_.pop_front())
    bytes += samples_.front().second;
  return bytes;
}

void RplidarEmulator::reboot() {
  in_.clear();
  samples_.clear();
  scanning_ = false;
  out_ = "RP LIDAR System.\r\nFirmware Ver 1.29\r\n";
}

}  // namespace tread::sim
