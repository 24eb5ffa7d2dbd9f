// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <cstring>
#include <random>
#include <string>
#include <string_view>

#include <GeographicLib/LocalCartesian.hpp>

#include "modules/simulator/emulators/emulator.hpp"

namespace tread::sim {

/// Faults of a device with binary messages, or of its line.
struct BinaryInsFaults {
  bool silent = false;         ///< stalled: sends nothing
  bool no_fix = false;         ///< no satellites and no inertial solution
  double drop_share = 0.0;     ///< probability that a message loses a byte
  double corrupt_share = 0.0;  ///< probability that one bit of a message is flipped
  double cut_share = 0.0;      ///< probability that a message breaks off
  double garbage_share = 0.0;  ///< probability of random bytes before a message
};

/// A message as its bytes, little-endian.
class Bytes {
 public:
  template <class Number>
  void put(Number number) {
    char raw[sizeof number];
    std::memcpy(raw, &number, sizeof number);
    bytes_.append(raw, sizeof number);
  }
  void zeros(size_t count) { bytes_.append(count, '\0'); }
  void append(std::string_view bytes) { bytes_.append(bytes); }
  const std::string& str() const { return bytes_; }

 private:
  std::string bytes_;
};

/// A measurement with its position and time on Earth.
struct EarthFix {
  double latitude = 0.0;   ///< [deg]
  double longitude = 0.0;  ///< [deg]
  double height = 0.0;     ///< above the ellipsoid [m]
  double azimuth = 0.0;    ///< of the nose, clockwise from north, 0..360 [deg]
  double north = 0.0;      ///< velocity [m/s]
  double east = 0.0;       ///< [m/s]
  int64_t utc = 0;         ///< [us] since 1970
  int64_t gps = 0;         ///< GPS time [us] since 1980-01-06
};

/// Common part of the emulated INS with binary messages: position on Earth, faults, the line.
class BinaryInsEmulator : public InsEmulator {
 public:
  BinaryInsEmulator(const MapOnEarth& map, uint64_t seed);

  /// The device takes no commands; bytes to it are ignored.
  void receive(std::string_view /*bytes*/, int64_t /*utime*/) override {}
  void add(const InsMeasurement& sample) final;
  std::string transmit(int64_t utime) final;
  void setFaults(const BinaryInsFaults& faults) { faults_ = faults; }
  /// The device restarts: unsent messages are lost, and it has no solution for a while.
  void reboot(int64_t utime);

 protected:
  static constexpr int64_t kLeapSeconds = 18;

  virtual void say(const InsMeasurement& sample, const EarthFix& fix, bool valid) = 0;
  void send(const std::string& message);
  const MapOnEarth& map() const { return settings_; }
  int64_t started() const { return started_; }

 private:
  EarthFix fixOf(const InsMeasurement& sample) const;
  bool happens(double share);

  MapOnEarth settings_;
  GeographicLib::LocalCartesian map_;
  BinaryInsFaults faults_;
  std::mt19937_64 random_;
  int64_t started_ = -1'000'000'000;
  std::string out_;
};

}  // namespace tread::sim
