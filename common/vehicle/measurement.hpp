// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "common/geometry/se2.hpp"
#include "common/vehicle/effects.hpp"

namespace tread {

/// Pose and yaw rate at one moment, of the vehicle or as the INS says.
struct MotionSample {
  double time = 0.0;   ///< [s] since the start of the session
  Pose2 T_map_body;    ///< yaw unwrapped
  double omega = 0.0;  ///< [rad/s]
};

/// The pose at a moment between samples, along the arc that joins its neighbours.
/** Before the first and after the last sample the nearest arc goes on. `motion` in the order of
 * time, not empty, less than a full turn between samples. */
Pose2 poseAt(const std::vector<MotionSample>& motion, double time);

/// The yaw rate at a moment, linear between samples, constant before the first and after the last.
double yawRateAt(const std::vector<MotionSample>& motion, double time);

/// Whether the INS says the motion as it is: every measurement effect is off.
bool isPerfect(const MeasurementModel& measurement);

/// What the INS says, at the same moments, of a true motion.
/** With t' = t - ins_latency: the position is (1 + position_scale) (p(t') - R(yaw(t')) lever_arm),
 * the heading yaw(t' - heading_latency) - heading_misalignment + gyro_bias_heading gyro_bias t, the
 * yaw rate omega(t - ins_latency_gyro ins_latency) + gyro_bias. Everything 0 returns the motion bit
 * for bit. */
std::vector<MotionSample> measure(const std::vector<MotionSample>& motion,
                                  const MeasurementModel& measurement);

/// What the INS says at one moment: a yaw rate beside the pose as in measure().
MotionSample measuredAt(const std::vector<MotionSample>& motion,
                        const MeasurementModel& measurement, double time);

}  // namespace tread
