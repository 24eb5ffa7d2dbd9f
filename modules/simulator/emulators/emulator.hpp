// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "modules/simulator/core/instruments.hpp"
#include "modules/simulator/core/vehicle.hpp"

namespace tread::sim {

/// A device of the simulated robot at its end of the line: the interface for further ones.
/** Pure: bytes and time [us] are arguments; times must not go back between calls. */
class Emulator {
 public:
  virtual ~Emulator() = default;
  /// Bytes from the robot.
  virtual void receive(std::string_view bytes, int64_t utime) = 0;
  /// Bytes to the robot since the last call.
  virtual std::string transmit(int64_t utime) = 0;
  /// The line was closed and reopened.
  virtual void reconnect() {}
};

/// Position and time of the simulated map on Earth.
struct MapOnEarth {
  double origin_latitude = 50.3629;        ///< of the map's origin, WGS84 [deg]
  double origin_longitude = 7.5587;        ///< [deg]
  double origin_height = 120.0;            ///< above the ellipsoid [m]
  double geoid_separation = 47.0;          ///< geoid above the ellipsoid [m]
  int64_t utc_at_zero = 1790000000000000;  ///< UTC of utime 0 [us since 1970]
};

/// An INS behind its driver's line.
class InsEmulator : public Emulator {
 public:
  /// A measurement that leaves the device now.
  virtual void add(const InsMeasurement& sample) = 0;
};

/// A range finder behind its driver's line.
class LaserEmulator : public Emulator {
 public:
  /// A scan that the device has just finished.
  virtual void add(const LaserScan& scan) = 0;
};

/// Measurements of a motor controller, from the simulated drive, by channel.
struct DriveMeasurements {
  double battery_voltage = 25.6;  ///< [V]
  MotorValues motor_current{};    ///< [A]
  MotorValues track_speed{};      ///< [m/s]
};

/// A motor controller behind its driver's line.
class MotorEmulator : public Emulator {
 public:
  /// Present power of the motors of all channels, -1..1. If the controller is configured to control
  /// speeds and heldSpeeds() does not return them: the commanded shares of its top speed.
  virtual MotorValues output(int64_t utime) = 0;
  /// The speeds that it controls itself, by channel [m/s]; output() is the resulting power.
  virtual std::optional<MotorValues> heldSpeeds() const { return std::nullopt; }
  virtual void measure(const DriveMeasurements& measurements) = 0;
};

}  // namespace tread::sim
