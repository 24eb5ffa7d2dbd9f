// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

namespace tread {

/// Values of the parameters of all vehicle effects, in the order in which they act; 0 = off.
/** What each one means, its unit and its bounds stand in the catalogue (effects.hpp). Limits are
 * held as their reciprocals, so that no limit is 0 and small values are weak effects. */
struct EffectValues {
  // What the drive makes of a command, per track.
  double command_delay = 0.0;         ///< [s], added to the model's delay
  double motor_deadband = 0.0;        ///< [m/s]
  double speed_saturation = 0.0;      ///< [s/m], 1 / top speed
  double battery_sag_per_hour = 0.0;  ///< [1/h]
  double battery_sag_per_drop = 0.0;  ///< [1]
  double thermal_derating = 0.0;      ///< [1]
  double thermal_time = 240.0;        ///< [s], shape
  double track_asymmetry = 0.0;       ///< [1]
  double actuator_lag = 0.0;          ///< [s], added to the model's lag
  double lag_asymmetry = 0.0;         ///< [s]
  double slew_limit = 0.0;            ///< [s2/m], 1 / greatest acceleration
  double track_backlash = 0.0;        ///< [m]
  // What the ground makes of the tracks.
  double slip_ratio = 0.0;           ///< [1]
  double terrain_time_1 = 0.0;       ///< [s], shape
  double terrain_time_2 = 0.0;       ///< [s], shape
  double terrain_slip_1 = 0.0;       ///< [1]
  double terrain_width_1 = 0.0;      ///< [1]
  double terrain_breakaway_1 = 0.0;  ///< [rad/s]
  double terrain_slip_2 = 0.0;       ///< [1]
  double terrain_width_2 = 0.0;      ///< [1]
  double terrain_breakaway_2 = 0.0;  ///< [rad/s]
  double track_width = 0.0;          ///< [1]
  double yaw_rate_skid = 0.0;        ///< [s]
  double yaw_breakaway = 0.0;        ///< [rad/s]
  double turn_power_limit = 0.0;     ///< [s/rad], 1 / greatest yaw rate
  double speed_understeer = 0.0;     ///< [s2/m2]
  double reverse_yaw_gain = 0.0;     ///< [s/m]
  double payload_yaw = 0.0;          ///< [1]
  double payload_speed = 0.0;        ///< [1]
  double payload_icr = 0.0;          ///< [m]
  double payload_time = 0.0;         ///< [s], shape
  double grip_limit = 0.0;           ///< [1], 1 / friction
  double yaw_pull = 0.0;             ///< [rad/m]
  double yaw_rate_offset = 0.0;      ///< [rad/s]
  double turn_speed_loss = 0.0;      ///< [s]
  double reverse_speed_gain = 0.0;   ///< [1]
  double quadratic_drag = 0.0;       ///< [s/m]
  double rolling_resistance = 0.0;   ///< [m/s]
  // The body.
  double yaw_inertia = 0.0;        ///< [s]
  double body_inertia = 0.0;       ///< [s]
  double icr_offset = 0.0;         ///< [m]
  double crab = 0.0;               ///< [rad]
  double centrifugal_drift = 0.0;  ///< [s]
  double slope_pitch = 0.0;        ///< [s]
  double slope_roll = 0.0;         ///< [s]
};

/// Values of the parameters of all measurement effects: what the INS makes of the true motion.
/** See measurement.hpp for what they do, effects.hpp for units and bounds; 0 = off. */
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

}  // namespace tread
