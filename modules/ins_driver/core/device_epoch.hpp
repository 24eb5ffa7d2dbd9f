// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <cstdint>
#include <optional>

#include <Eigen/Core>

#include "modules/ins_driver/core/ins_source.hpp"

namespace tread::ins {

/// A device's report on its position: a fix, or that it has none.
struct PositionReport {
  std::optional<GeoPoint> point;                                 ///< WGS84 [rad]; absent: no fix
  std::optional<double> altitude;                                ///< above mean sea level [m]
  Eigen::Vector3d std = Eigen::Vector3d::Constant(kUnmeasured);  ///< along east, north, up [m]
  bool starts_map = true;   ///< accurate enough to become the map's origin
  bool complete = true;     ///< false: a report with the altitude may still follow
  bool at_antenna = false;  ///< of the GNSS antenna, not of the INS's reference point
  int rank = 0;  ///< of two reports of the same instant the higher rank counts, otherwise the later
};

/// Motion over ground of the device's reference point.
struct GroundVelocity {
  double speed = 0.0;  ///< horizontal, never negative [m/s]
  /// Direction of motion as a yaw, counter-clockwise from east [rad]
  std::optional<double> course;
  double up = kUnmeasured;   ///< [m/s]
  double std = kUnmeasured;  ///< along each horizontal axis [m/s]
  int rank = 0;              ///< as in PositionReport
};

/// Ground velocity from components along north, east and up [m/s].
GroundVelocity groundVelocity(double north, double east, double up, double std, int rank);

struct Heading {
  double yaw = 0.0;          ///< of the device's nose, counter-clockwise from east [rad]
  double std = kUnmeasured;  ///< [rad]
};

/// A device's data of one instant, or the part of them in one message, in the common form of all
/// devices.
/** Axes of the device are forward, left, up; pitch is positive nose down, roll right side down. */
struct DeviceEpoch {
  int64_t arrival = 0;  ///< host time of the first byte of the first message [us]
  /// Counted as in DeviceClock [us]; absent if no message contained it
  std::optional<int64_t> device_time;
  int64_t device_utc = -1;     ///< [us] since 1970-01-01; -1 before the device sent a date
  bool clock_was_set = false;  ///< the device's clock was set, forwards or back, before this epoch
  uint32_t kinds = 0;          ///< bit n: contains a message of kind n

  std::optional<PositionReport> position;
  std::optional<GroundVelocity> velocity;
  std::array<std::optional<Heading>, 2> headings;  ///< kAttitude, kDualAntenna of HeadingSource
  std::optional<double> pitch;                     ///< [rad]
  std::optional<double> roll;                      ///< [rad]
  double pitch_std = kUnmeasured;                  ///< [rad]
  double roll_std = kUnmeasured;                   ///< [rad]
  std::optional<double> yaw_rate;  ///< about the vertical, counter-clockwise positive [rad/s]
  std::optional<Eigen::Vector3d> rate_device;  ///< about the device's axes [rad/s]
  int satellites = -1;                         ///< -1 unknown

  std::optional<Heading>& heading(HeadingSource source) {
    return headings[static_cast<size_t>(source)];
  }
  bool holds(size_t kind) const { return (kinds >> kind & 1U) != 0; }
  /// Adds the data of a message of the same instant.
  void take(const DeviceEpoch& part, size_t kind);
};

}  // namespace tread::ins
