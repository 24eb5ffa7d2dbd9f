// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <Eigen/Core>

#include "common/geometry/se2.hpp"

namespace tread::sim {

/// Place and attitude of a vehicle that lies on the ground.
struct BodyPose {
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();           ///< of the body origin [m]
  Eigen::Matrix3d R_map_body = Eigen::Matrix3d::Identity();  ///< Rz(yaw) Ry(pitch) Rx(roll)
  double pitch = 0.0;                                        ///< nose down positive [rad]
  double roll = 0.0;                                         ///< left side up positive [rad]
};

/// The body on ground of a height [m] and gradient [1]; yaw is the heading of x_body seen from
/// above.
BodyPose poseOnGround(const Pose2& T_map_body, double height, const Eigen::Vector2d& gradient);

}  // namespace tread::sim
