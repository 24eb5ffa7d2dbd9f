// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <Eigen/Core>

#include "common/geometry/se2.hpp"

namespace tread::scan_matching {

/// Motion of a body between scans.
struct MotionConfig {
  double acceleration = 1.0;      ///< [m/s2] standard deviation, along x and y of the body
  double yaw_acceleration = 1.5;  ///< [rad/s2]
  double correlation = 0.5;       ///< [s] duration of an acceleration
  double start_speed = 0.3;       ///< [m/s], and [rad/s], before the first two scans
  double lateral_speed = 0.1;     ///< [m/s] sideways: tracks and wheels hardly slip sideways
  double standing_speed = 0.005;  ///< [m/s], and [rad/s], long after the motors were switched off
  double speed = 1.0;     ///< [m/s] upper limit of the standard deviation without measurements
  double yaw_rate = 0.7;  ///< [rad/s] the same
};

/// Pose and twist of a body with constant velocity except for random accelerations: a Kalman
/// filter.
/** State: x, y [m] and yaw [rad] in map, v_x, v_y [m/s] and omega [rad/s] in body. */
class MotionFilter {
 public:
  using Covariance = Eigen::Matrix<double, 6, 6>;

  MotionFilter(const MotionConfig& config, const Pose2& T_map_body);

  /// Predicts over dt [s].
  void predict(double dt);
  /// Applies prior knowledge of the motion over dt [s]: hardly any sideways motion, or standstill.
  void constrain(double dt, bool standing);
  /// Takes the result of a match at the predicted pose: the posterior pose and its covariance
  /// (3x3).
  void update(const Pose2& T_map_body, const Eigen::Matrix3d& covariance);
  /// Takes the present pose as reference: its own uncertainty becomes zero.
  void anchor();

  const Pose2& pose() const { return pose_; }
  const Twist2& twist() const { return twist_; }
  Eigen::Matrix3d poseCovariance() const { return covariance_.topLeftCorner<3, 3>(); }
  Eigen::Matrix3d twistCovariance() const { return covariance_.bottomRightCorner<3, 3>(); }

 private:
  void limitTwist();
  void measureTwist(int axis, double variance);

  MotionConfig config_;
  Pose2 pose_;
  Twist2 twist_;
  Covariance covariance_ = Covariance::Zero();
};

}  // namespace tread::scan_matching
