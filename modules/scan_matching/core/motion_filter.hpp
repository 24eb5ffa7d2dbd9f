// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <Eigen/Core>

#include "common/geometry/se2.hpp"

namespace tread::scan_matching {

/// How a body may move between scans.
struct MotionConfig {
  double acceleration = 1.0;      ///< [m/s2] standard deviation, along x and y of the body
  double yaw_acceleration = 1.5;  ///< [rad/s2]
  double correlation = 0.5;       ///< [s] for which an acceleration lasts
  double start_speed = 0.3;       ///< [m/s], and [rad/s], before the first two scans
  double lateral_speed = 0.1;     ///< [m/s] sideways: tracks and wheels hardly slip so
  double standing_speed = 0.005;  ///< [m/s], and [rad/s], while the motors have been off for long
  double speed = 1.0;             ///< [m/s] standard deviation, however long nothing was measured
  double yaw_rate = 0.7;          ///< [rad/s] the same
};

/// Pose and twist of a body that goes on as it goes, but for accelerations: a Kalman filter.
/** State: x, y [m] and yaw [rad] in map, v_x, v_y [m/s] and omega [rad/s] in body. */
class MotionFilter {
 public:
  using Covariance = Eigen::Matrix<double, 6, 6>;

  MotionFilter(const MotionConfig& config, const Pose2& T_map_body);

  /// Goes on for dt [s].
  void predict(double dt);
  /// What is known of the motion over dt [s] without any scan: hardly sideways, or not at all.
  void constrain(double dt, bool standing);
  /// Takes what a match made of the predicted pose: the posterior pose and its covariance (3x3).
  void update(const Pose2& T_map_body, const Eigen::Matrix3d& covariance);
  /// From now on the pose is counted from where it is: its own uncertainty is nothing.
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
