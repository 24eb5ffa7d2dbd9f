// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/emulators/binary_ins_emulator.hpp"

#include <cmath>
#include <utility>

namespace tread::sim {
namespace {

constexpr double kDegree = kPi / 180.0;
constexpr int64_t kGpsStartUs = int64_t{315964800} * 1000000;
constexpr int64_t kAlignmentUs = 3'000'000;

}  // namespace

BinaryInsEmulator::BinaryInsEmulator(const MapOnEarth& map, uint64_t seed)
    : settings_(map),
      map_(map.origin_latitude, map.origin_longitude, map.origin_height),
      random_(seed) {}

EarthFix BinaryInsEmulator::fixOf(const InsMeasurement& sample) const {
  EarthFix fix;
  map_.Reverse(sample.p_map.x(), sample.p_map.y(), sample.p_map.z(), fix.latitude, fix.longitude,
               fix.height);
  fix.azimuth = std::fmod(std::remainder(90.0 - sample.yaw / kDegree, 360.0) + 360.0, 360.0);
  const double c = std::cos(sample.yaw);
  const double s = std::sin(sample.yaw);
  fix.east = c * sample.v_body.x() - s * sample.v_body.y();
  fix.north = s * sample.v_body.x() + c * sample.v_body.y();
  fix.utc = settings_.utc_at_zero + sample.utime;
  fix.gps = fix.utc - kGpsStartUs + kLeapSeconds * 1'000'000;
  return fix;
}

void BinaryInsEmulator::add(const InsMeasurement& sample) {
  if (faults_.silent) return;
  say(sample, fixOf(sample), !faults_.no_fix && sample.utime - started_ >= kAlignmentUs);
}

void BinaryInsEmulator::reboot(int64_t utime) {
  started_ = utime;
  out_.clear();
}

bool BinaryInsEmulator::happens(double share) {
  return share > 0.0 && static_cast<double>(random_() >> 11) * 0x1.0p-53 < share;
}

void BinaryInsEmulator::send(const std::string& message) {
  std::string bytes = message;
  if (happens(faults_.garbage_share)) {
    for (size_t i = random_() % 40; i > 0; --i) out_ += static_cast<char>(random_() % 256);
  }
  if (happens(faults_.drop_share)) bytes.erase(random_() % bytes.size(), 1);
  if (happens(faults_.corrupt_share)) {
    const size_t bit = random_() % (bytes.size() * 8);
    bytes[bit / 8] = static_cast<char>(bytes[bit / 8] ^ (1 << bit % 8));
  }
  if (happens(faults_.cut_share)) bytes.resize(random_() % bytes.size());
  out_ += bytes;
}

std::string BinaryInsEmulator::transmit(int64_t /*utime*/) {
  return std::exchange(out_, {});
}

}  // namespace tread::sim
