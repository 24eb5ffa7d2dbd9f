// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <Eigen/Geometry>

#include "common/geometry/se2.hpp"

namespace tread {

/// Yaw, pitch, roll of a rotation R_map_body = Rz(yaw) Ry(pitch) Rx(roll) [rad]; nose down is
/// positive pitch.
struct YawPitchRoll {
  double yaw = 0.0;
  double pitch = 0.0;
  double roll = 0.0;
};

/// Position and orientation of an instrument in the body frame.
struct Mounting {
  Eigen::Vector3d p_body = Eigen::Vector3d::Zero();  ///< [m]
  YawPitchRoll angles;                               ///< of its forward-left-up axes [rad]
};

/// Transform from a position [m] and yaw, pitch, roll [rad]. Uses mrpt::poses::CPose3D.
Eigen::Isometry3d isometryFrom(const Eigen::Vector3d& position, const YawPitchRoll& angles);

/// Yaw, pitch and roll of a rotation, also at pitch +-90 degrees. Uses mrpt::poses::CPose3D.
YawPitchRoll yawPitchRoll(const Eigen::Quaterniond& R_map_body);

/// The pose a share 0..1 of the way from one to another: position linearly, orientation the short
/// way round.
Eigen::Isometry3d interpolated(const Eigen::Isometry3d& first, const Eigen::Isometry3d& last,
                               double share);

/// The pose in the plane below a pose in space: x, y and yaw.
Pose2 planar(const Eigen::Vector3d& p_map, const Eigen::Quaterniond& R_map_body);

}  // namespace tread
