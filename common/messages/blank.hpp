// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <limits>

#include "common/bus/channels.hpp"

namespace tread {

namespace detail {

constexpr double kUnknownNumber = std::numeric_limits<double>::quiet_NaN();

inline void setUnknown(double& field) {
  field = kUnknownNumber;
}
inline void setUnknown(float& field) {
  field = static_cast<float>(kUnknownNumber);
}
template <class Number, size_t size>
void setUnknown(Number (&field)[size]) {
  for (Number& number : field) setUnknown(number);
}
template <class... Fields>
void setAllUnknown(Fields&... fields) {
  (setUnknown(fields), ...);
}

// Values of "not measured" and "not set", from each type's .lcm file, where they are not 0, false
// or empty.
template <class Message>
void markUnknown(Message& /*m*/) {}
inline void markUnknown(execution_record_t& m) {
  m.ended = -1;
}
inline void markUnknown(goal_t& m) {
  setAllUnknown(m.goal_pose, m.position_tolerance, m.yaw_tolerance);
}
inline void markUnknown(grip_t& m) {
  setUnknown(m.deceleration);
}
inline void markUnknown(health_t& m) {
  m.utc = -1;
}
inline void markUnknown(ins_t& m) {
  setAllUnknown(m.position, m.orientation, m.velocity, m.rate, m.position_std, m.attitude_std);
  m.device_utc = -1;
  m.satellites = -1;
  m.ins_status = ins_t::STATUS_NO_POSITION | ins_t::STATUS_NO_HEADING | ins_t::STATUS_NO_ATTITUDE |
                 ins_t::STATUS_NO_VELOCITY;
}
inline void markUnknown(learning_t& m) {
  setAllUnknown(m.error_position, m.error_yaw, m.error_position_after, m.error_yaw_after,
                m.measured_end, m.predicted_end, m.path_length, m.scaling, m.measured_entry,
                m.ground_changed, m.surface_probability, m.slope);
}
inline void markUnknown(manual_t& m) {
  setAllUnknown(m.hand_left, m.hand_right);
}
inline void markUnknown(map_tile_t& m) {
  setUnknown(m.cell_size);
}
inline void markUnknown(motor_t& m) {
  setAllUnknown(m.command, m.battery_voltage, m.current, m.measured);
  m.command_index = -1;
}
inline void markUnknown(pattern_set_part_t& m) {
  setAllUnknown(m.entry_twist, m.exit_twist, m.end_covariance);
}
inline void markUnknown(plan_t& m) {
  setAllUnknown(m.time_to_go, m.risk, m.risk_per_metre);
}
inline void markUnknown(program_t& m) {
  m.newest_input_seq = -1;
}
inline void markUnknown(shock_t& m) {
  setAllUnknown(m.shock_weights, m.shock_covariance, m.shock_variance, m.here_shock, m.felt_shock,
                m.felt_peak, m.felt_pitch_rate, m.felt_speed);
}
inline void markUnknown(stopping_t& m) {
  setUnknown(m.stopping_time);
}
inline void markUnknown(scan_t& m) {
  setAllUnknown(m.sensor_position, m.sensor_orientation, m.angle_first, m.angle_step, m.range_min,
                m.range_max);
}

}  // namespace detail

/// A message in which every field is "unknown" or "none", as its .lcm file defines it. Publishers
/// begin with it, so that a new field is never a 0 that looks measured.
template <class Message>
Message blank() {
  Message message{};
  detail::markUnknown(message);
  return message;
}

}  // namespace tread
