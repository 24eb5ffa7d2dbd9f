// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/core/body_pose.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Geometry>

namespace tread::sim {

BodyPose poseOnGround(const Pose2& T_map_body, double height, const Eigen::Vector2d& gradient) {
  const Eigen::Vector2d heading(std::cos(T_map_body.yaw), std::sin(T_map_body.yaw));
  const Eigen::Vector3d up = Eigen::Vector3d(-gradient.x(), -gradient.y(), 1.0).normalized();
  const Eigen::Vector3d forward =
      Eigen::Vector3d(heading.x(), heading.y(), gradient.dot(heading)).normalized();
  const Eigen::Vector3d left = up.cross(forward);
  BodyPose body;
  body.p_map = {T_map_body.x, T_map_body.y, height};
  body.R_map_body.col(0) = forward;
  body.R_map_body.col(1) = left;
  body.R_map_body.col(2) = up;
  body.pitch = -std::asin(std::clamp(forward.z(), -1.0, 1.0));
  body.roll = std::atan2(left.z(), up.z());
  return body;
}

}  // namespace tread::sim
