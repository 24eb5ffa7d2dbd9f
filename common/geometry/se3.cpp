// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/geometry/se3.hpp"

// MRPT's matrices need all of Eigen to be declared before them.
#include <Eigen/Dense>

#include <mrpt/poses/CPose3D.h>

namespace tread {

Eigen::Isometry3d isometryFrom(const Eigen::Vector3d& position, const YawPitchRoll& angles) {
  const mrpt::poses::CPose3D pose(position.x(), position.y(), position.z(), angles.yaw,
                                  angles.pitch, angles.roll);
  const mrpt::math::CMatrixDouble33& rotation = pose.getRotationMatrix();
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) T.linear()(row, column) = rotation(row, column);
  T.translation() = position;
  return T;
}

YawPitchRoll yawPitchRoll(const Eigen::Quaterniond& R_map_body) {
  const Eigen::Matrix3d matrix = R_map_body.normalized().toRotationMatrix();
  mrpt::math::CMatrixDouble33 rotation;
  for (int row = 0; row < 3; ++row)
    for (int column = 0; column < 3; ++column) rotation(row, column) = matrix(row, column);
  mrpt::poses::CPose3D pose;
  pose.setRotationMatrix(rotation);
  YawPitchRoll angles;
  pose.getYawPitchRoll(angles.yaw, angles.pitch, angles.roll);
  return angles;
}

Eigen::Isometry3d interpolated(const Eigen::Isometry3d& first, const Eigen::Isometry3d& last,
                               double share) {
  const Eigen::Quaterniond from(first.linear());
  const Eigen::Quaterniond to(last.linear());
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  T.linear() = from.slerp(share, to).toRotationMatrix();
  T.translation() = first.translation() + share * (last.translation() - first.translation());
  return T;
}

Pose2 planar(const Eigen::Vector3d& p_map, const Eigen::Quaterniond& R_map_body) {
  return {p_map.x(), p_map.y(), yawPitchRoll(R_map_body).yaw};
}

}  // namespace tread
