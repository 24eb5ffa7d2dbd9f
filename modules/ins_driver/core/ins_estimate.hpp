// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <limits>
#include <optional>

#include <Eigen/Geometry>

#include "common/geometry/se3.hpp"
#include "modules/ins_driver/core/local_frame.hpp"

namespace tread::ins {

inline constexpr double kUnmeasured = std::numeric_limits<double>::quiet_NaN();

/// Bits of InsEstimate::status; the same values as in ins_t.
enum InsStatus : int32_t {
  kGood = 0,
  kNoPosition = 1,
  kNoHeading = 2,
  kGap = 4,
  kJump = 8,
  kNoAttitude = 16,
  kNoVelocity = 32
};

/// What the device measured at one instant, of the body in the map. NaN where it did not measure.
struct InsEstimate {
  int64_t utime = 0;        ///< host time of the measurement [us]
  int64_t device_utc = -1;  ///< [us] since 1970-01-01; -1 before the device told a date
  Eigen::Vector3d p_map_body = Eigen::Vector3d::Constant(kUnmeasured);  ///< [m]
  Eigen::Quaterniond R_map_body = {kUnmeasured, kUnmeasured, kUnmeasured, kUnmeasured};
  /// Forward and left: velocity over the level ground; up: never measured by NMEA [m/s].
  Eigen::Vector3d v_body = Eigen::Vector3d::Constant(kUnmeasured);
  Eigen::Vector3d rate_body = Eigen::Vector3d::Constant(kUnmeasured);     ///< [rad/s]
  Eigen::Vector3d position_std = Eigen::Vector3d::Constant(kUnmeasured);  ///< along map axes [m]
  Eigen::Vector3d attitude_std =
      Eigen::Vector3d::Constant(kUnmeasured);  ///< roll, pitch, yaw [rad]
  int32_t status = kGood;                      ///< bits of InsStatus
  int satellites = -1;                         ///< -1 unknown
};

/// How the device sits in the vehicle and what it may be believed.
struct InsConfig {
  /// The point whose position the device reports (antenna or INS reference), in body [m].
  Eigen::Vector3d p_body_antenna = Eigen::Vector3d::Zero();
  /// Rotation of the device's forward-left-up axes in body [rad].
  YawPitchRoll body_device;
  /// The map's place on Earth; absent: the first good fix, x to the east.
  std::optional<GeoOrigin> origin;
  /// A fix with a larger dilution of precision does not become the origin [1].
  double origin_max_hdop = 5.0;
  /// Positions further from the origin are refused: the plane no longer fits the Earth (20 km: 31 m
  /// too low) [m].
  double max_distance = 20000.0;
  /// Below this speed the course is noise: the velocity counts as zero [m/s].
  double standstill_speed = 0.1;
  /// Faster than the vehicle can go: a position further off than that is a jump [m/s].
  double max_speed = 10.0;
  /// Distance that is never called a jump [m].
  double jump_slack = 0.5;
  /// From the measurement to the first byte on the shortest way: the device's and the line's delay
  /// [us].
  int64_t latency_us = 0;
  /// Silence on the line that ends an epoch [us].
  int64_t quiet_us = 10'000;
  /// Index in NmeaSentence of the type that ends each epoch, so that the silence need not be
  /// awaited.
  std::optional<size_t> last_type;
  /// Longest time that an attitude is carried to a position measured after it [us].
  int64_t attitude_hold_us = 60'000;
  /// Window of the arrival filter [us].
  int64_t offset_window_us = 10'000'000;
  /// Nominal time between positions, to tell gaps [us]; 0 = learn it.
  int64_t period_us = 0;
  /// Also publish instants at which only the attitude was measured.
  bool attitude_epochs = false;
};

}  // namespace tread::ins
