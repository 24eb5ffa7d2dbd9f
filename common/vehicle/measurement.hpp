// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "common/geometry/se2.hpp"

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

/// Values of the parameters of all measurement effects: what the INS makes of the true motion.
/** Units and bounds stand in the catalogue; 0 = off. A new one is a value here, a line of
 * measured() and its entry in the catalogue. */
struct MeasurementModel {
  double ins_latency = 0.0;           ///< [s]
  double ins_latency_gyro = 0.0;      ///< [1], shape: share of it that the yaw rate has, too
  double heading_latency = 0.0;       ///< [s], of the heading behind the position
  double position_scale = 0.0;        ///< [1]
  double lever_arm_x = 0.0;           ///< [m]
  double lever_arm_y = 0.0;           ///< [m]
  double heading_misalignment = 0.0;  ///< [rad]
  double gyro_bias = 0.0;             ///< [rad/s]
  double gyro_bias_heading = 0.0;     ///< [1], shape: share of it that the heading integrates
};

/// Whether the INS says the motion as it is: every measurement effect is off.
bool isPerfect(const MeasurementModel& measurement);

/// What the INS says at the moment of a sample of a true motion.
/** With t' = t - ins_latency: the position is (1 + position_scale) (p(t') - R(yaw(t')) lever_arm),
 * the heading yaw(t' - heading_latency) - heading_misalignment + gyro_bias_heading gyro_bias t, the
 * yaw rate omega(t - ins_latency_gyro ins_latency) + gyro_bias. Everything 0 returns the motion bit
 * for bit. */
inline MotionSample measured(const std::vector<MotionSample>& motion, const MeasurementModel& ins,
                             const MotionSample& now) {
  MotionSample said = now;
  Pose2& pose = said.T_map_body;
  if (ins.ins_latency != 0.0) pose = poseAt(motion, now.time - ins.ins_latency);
  if (ins.lever_arm_x != 0.0 || ins.lever_arm_y != 0.0) {
    const Eigen::Vector2d p = pose * Eigen::Vector2d(-ins.lever_arm_x, -ins.lever_arm_y);
    pose.x = p.x();
    pose.y = p.y();
  }
  pose.x *= 1.0 + ins.position_scale;
  pose.y *= 1.0 + ins.position_scale;
  if (ins.heading_latency != 0.0)
    pose.yaw = poseAt(motion, now.time - ins.ins_latency - ins.heading_latency).yaw;
  pose.yaw -= ins.heading_misalignment;
  pose.yaw += ins.gyro_bias_heading * ins.gyro_bias * now.time;
  const double gyro_latency = ins.ins_latency_gyro * ins.ins_latency;
  if (gyro_latency != 0.0) said.omega = yawRateAt(motion, now.time - gyro_latency);
  said.omega += ins.gyro_bias;
  return said;
}

/// The same at all its moments.
std::vector<MotionSample> measure(const std::vector<MotionSample>& motion,
                                  const MeasurementModel& measurement);

/// What the INS says at one moment: a yaw rate beside the pose as in measure().
MotionSample measuredAt(const std::vector<MotionSample>& motion,
                        const MeasurementModel& measurement, double time);

}  // namespace tread
