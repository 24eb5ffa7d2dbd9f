// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>

#include <tread/ins_t.hpp>

#include "common/geometry/se3.hpp"

namespace tread {

/// The pose of a plausible INS message in the plane; nothing if position or heading is missing or
/// not finite.
std::optional<Pose2> planarPose(const ins_t& ins);

/// T_map_body of a plausible INS message; nothing as above, or if the height is missing (a device
/// that speaks RMC only).
std::optional<Eigen::Isometry3d> spatialPose(const ins_t& ins);

/// Body twist in the plane, or nothing if the device does not measure it.
std::optional<Twist2> planarTwist(const ins_t& ins);

/// Inclination of the ground under the robot [rad], from roll and pitch; nothing if attitude is
/// missing.
std::optional<double> inclination(const ins_t& ins);

}  // namespace tread
