// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/lidar_driver/velodyne/velodyne_packet.hpp"

#include <cmath>
#include <limits>
#include <map>

namespace tread::lidar {
namespace {

constexpr double kRadPerDeg = 3.14159265358979323846 / 180.0;
constexpr size_t kBlocks = 12;
constexpr size_t kBlock = 100;
constexpr double kLaserPeriod = 2.304;  // [us] from laser to laser
constexpr double kFullTurn = 36000.0;   // [0.01 deg]
/// At 20 revolutions a second a block of two firings turns by 0.8 degree [0.01 deg].
constexpr double kMostTurn = 120.0;
constexpr double kRangeUnit = 0.002;  // [m]
constexpr uint32_t kHour = 3'600'000'000U;
constexpr unsigned kDualReturn = 0x39;

unsigned byteAt(std::string_view bytes, size_t at) {
  return static_cast<unsigned char>(bytes[at]);
}
uint32_t wordAt(std::string_view bytes, size_t at) {
  return byteAt(bytes, at) | byteAt(bytes, at + 1) << 8;
}

/// Direction of a laser, in the order of firing (manual, table 9-1).
struct Laser {
  double elevation;  // [deg]
  double up;         // [mm] of its origin
};
using Lasers = std::array<Laser, kVelodyneLasers>;
constexpr Lasers kVlp16 = {{{-15, 11.2},
                            {1, -0.7},
                            {-13, 9.7},
                            {3, -2.2},
                            {-11, 8.1},
                            {5, -3.7},
                            {-9, 6.6},
                            {7, -5.1},
                            {-7, 5.1},
                            {9, -6.6},
                            {-5, 3.7},
                            {11, -8.1},
                            {-3, 2.2},
                            {13, -9.7},
                            {-1, 0.7},
                            {15, -11.2}}};
constexpr Lasers kHiRes = {{{-10.0, 7.4},
                            {0.67, -0.9},
                            {-8.67, 6.5},
                            {2.0, -1.8},
                            {-7.33, 5.5},
                            {3.33, -2.7},
                            {-6.0, 4.6},
                            {4.67, -3.7},
                            {-4.67, 3.7},
                            {6.0, -4.6},
                            {-3.33, 2.7},
                            {7.33, -5.5},
                            {-2.0, 1.8},
                            {8.67, -6.5},
                            {-0.67, 0.9},
                            {10.0, -7.4}}};

/// Names by the factory bytes; the old HDL-64E uses them differently.
std::string nameOf(unsigned product) {
  static const std::map<unsigned, std::string> kNames{
      {0x21, "HDL-32E"}, {0x23, "VLP-32A or B"}, {0x28, "VLP-32C"}, {0x31, "Velarray"},
      {0x63, "VLS-128"}, {0xA0, "HDL-64E"},      {0xA1, "VLS-128"}};
  const auto found = kNames.find(product);
  return found != kNames.end() ? found->second : "of a number that is not known";
}

bool hasMoreLasers(std::string_view bytes) {
  for (size_t block = 0; block < kBlocks; ++block)
    if (wordAt(bytes, kBlock * block) != 0xEEFF) return true;
  return false;
}

const Lasers* lasersOf(unsigned product) {
  if (product == 0x22) return &kVlp16;
  if (product == 0x24) return &kHiRes;
  return nullptr;
}

/// Change of azimuth between consecutive blocks [0.01 deg]; nullopt if they are not continuous.
std::optional<double> turnBetween(double from, double to) {
  const double turn = std::fmod(to - from + kFullTurn, kFullTurn);
  return turn <= kMostTurn ? std::optional(turn) : std::nullopt;
}

/// The 16 ranges from `at` on; the azimuth is the first laser's, and `turn` its change until the
/// next firing.
VelodyneFiring firingOf(std::string_view bytes, size_t at, double azimuth, double turn,
                        const Lasers& lasers) {
  VelodyneFiring firing;
  for (size_t laser = 0; laser < kVelodyneLasers; ++laser) {
    auto& point = firing.points[laser];
    const uint32_t range = wordAt(bytes, at + 3 * laser);
    if (range == 0) {
      point.fill(std::numeric_limits<float>::quiet_NaN());
      continue;
    }
    const double share = static_cast<double>(laser) * kLaserPeriod / kVelodyneFiringPeriod;
    const double clockwise = (azimuth + turn * share) * 0.01 * kRadPerDeg;
    const double elevation = lasers[laser].elevation * kRadPerDeg;
    const double level = kRangeUnit * range * std::cos(elevation);
    point = {
        static_cast<float>(level * std::cos(clockwise)),
        static_cast<float>(-level * std::sin(clockwise)),
        static_cast<float>(kRangeUnit * range * std::sin(elevation) + 0.001 * lasers[laser].up)};
  }
  return firing;
}

}  // namespace

bool isVelodynePacket(std::string_view bytes) {
  if (bytes.size() != kVelodynePacket) return false;
  for (size_t block = 0; block < kBlocks; ++block) {
    const uint32_t flag = wordAt(bytes, kBlock * block);
    if (flag != 0xEEFF && flag != 0xDDFF && flag != 0xCCFF && flag != 0xBBFF) return false;
  }
  return true;
}

std::optional<VelodynePacket> parseVelodynePacket(std::string_view bytes, std::string& problem) {
  const auto refuse = [&](const std::string& why) {
    problem = why;
    return std::nullopt;
  };
  if (!isVelodynePacket(bytes)) return refuse("bytes that are no packet");
  const unsigned product = byteAt(bytes, 1205);
  const Lasers* const lasers = lasersOf(product);
  if (hasMoreLasers(bytes))
    return refuse("packets of another product, " +
                  nameOf(product == 0xA1 || product == 0x63 ? product : 0xA0));
  if (lasers == nullptr) return refuse("packets of another product, " + nameOf(product));
  const unsigned mode = byteAt(bytes, 1204);
  if (mode < 0x37 || mode > kDualReturn) return refuse("packets of an unknown return mode");
  VelodynePacket packet;
  packet.past_hour = wordAt(bytes, 1200) | wordAt(bytes, 1202) << 16;
  if (packet.past_hour >= kHour) return refuse("packets of more than an hour past the hour");
  // With two returns each pair of blocks belongs to the same firings: the last returns come first.
  const size_t stride = mode == kDualReturn ? 2 : 1;
  double turn = 0.0;
  for (size_t block = 0; block < kBlocks; block += stride) {
    const double azimuth = wordAt(bytes, kBlock * block + 2);
    if (azimuth >= kFullTurn) return refuse("packets with an azimuth beyond 360 degrees");
    if (block + stride < kBlocks) {
      const auto next = turnBetween(azimuth, wordAt(bytes, kBlock * (block + stride) + 2));
      if (!next) return refuse("packets with discontinuous azimuths");
      turn = *next;
    }
    for (size_t half = 0; half < 2; ++half)
      packet.firings.push_back(firingOf(bytes, kBlock * block + 4 + 48 * half,
                                        azimuth + 0.5 * turn * static_cast<double>(half),
                                        0.5 * turn, *lasers));
  }
  return packet;
}

}  // namespace tread::lidar
