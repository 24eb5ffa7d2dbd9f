// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/emulators/velodyne/velodyne_emulator.hpp"

#include <algorithm>
#include <cmath>

namespace tread::sim {
namespace {

constexpr int kBlocks = 12;
constexpr double kFiring = 55.296;         // [us]
constexpr double kTurn = 100'000.0;        // [us]
constexpr double kHour = 3'600'000'000.0;  // [us]
constexpr int kUp = 1;                     // the laser 1 degree up, and
constexpr int kDown = 14;                  // the one 1 degree down

void appendWord(std::string& bytes, unsigned value) {
  bytes += static_cast<char>(value & 0xffU);
  bytes += static_cast<char>(value >> 8 & 0xffU);
}

double azimuthAt(double time) {
  return 36'000.0 * std::fmod(time, kTurn) / kTurn;
}

}  // namespace

void VelodyneEmulator::add(const LaserScan& scan) {
  const auto finished = static_cast<double>(scan.utime + laser_.sweep_us);
  if (scan_.ranges.empty()) firing_ = std::max(firing_, finished);
  scan_ = scan;
}

/// A range in steps of 2 mm; 0 without a return. Azimuth clockwise, 0.01 degree.
uint16_t VelodyneEmulator::ticksAt(double azimuth) const {
  const double angle = -std::remainder(azimuth * 0.01 * kPi / 180.0, 2.0 * kPi);
  const double step = laser_.field_of_view / (laser_.beams - 1);
  const auto beam = std::lround((angle + laser_.field_of_view / 2.0) / step);
  if (beam < 0 || beam >= static_cast<long>(scan_.ranges.size())) return 0;
  const float range = scan_.ranges[static_cast<size_t>(beam)];
  if (!std::isfinite(range) || range > 130.0F) return 0;
  return static_cast<uint16_t>(std::lround(range / 0.002F));
}

std::string VelodyneEmulator::packet() const {
  std::string bytes;
  const int told = faults_.dual_return ? 2 : 1;
  for (int block = 0; block < kBlocks; ++block) {
    const double begin = firing_ + 2.0 * kFiring * (block / told);
    bytes += "\xFF\xEE";
    appendWord(bytes, static_cast<unsigned>(azimuthAt(begin)));
    for (int point = 0; point < 32; ++point) {
      const int laser = point % 16;
      const double time = begin + kFiring * (point / 16) + 2.304 * laser;
      const bool sees = laser == kUp || laser == kDown;
      appendWord(bytes, sees ? ticksAt(azimuthAt(time)) : 0U);
      bytes += '\x20';  // reflectivity
    }
  }
  const auto stamp = static_cast<uint32_t>(std::fmod(firing_ - powered_, kHour));
  appendWord(bytes, stamp & 0xffffU);
  appendWord(bytes, stamp >> 16);
  bytes += faults_.dual_return ? '\x39' : '\x37';
  bytes += faults_.other_product ? '\x21' : '\x22';
  return bytes;
}

void VelodyneEmulator::spoil(std::string& packet) const {
  if (faults_.wrong_flag) packet[500] = '\x7F';
  if (faults_.half_packet) packet.resize(600);
  if (faults_.silent || (faults_.lost_packet && sent_ % 3 == 0)) packet.clear();
}

std::string VelodyneEmulator::transmit(int64_t utime) {
  std::string bytes;
  if (scan_.ranges.empty()) return bytes;
  const double duration = 2.0 * kFiring * kBlocks / (faults_.dual_return ? 2 : 1);
  // Packets unsent because of a pause of the host are lost.
  const auto now = static_cast<double>(utime);
  if (now - firing_ > kTurn) firing_ += duration * std::floor((now - firing_) / duration - 1.0);
  for (; firing_ + duration <= now; firing_ += duration) {
    std::string next = packet();
    ++sent_;
    spoil(next);
    bytes += next;
  }
  return bytes;
}

void VelodyneEmulator::reboot(int64_t utime) {
  scan_ = {};
  firing_ = powered_ = static_cast<double>(utime);
}

}  // namespace tread::sim
