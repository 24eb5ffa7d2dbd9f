// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/geometry/se2.hpp"
#include "common/pattern/command.hpp"

namespace tread {

class ConfigReader;

/// One driven wheel with rollers on its rim.
struct OmniWheel {
  double x = 0.0;        ///< [m] p_body of its contact
  double y = 0.0;        ///< [m]
  double heading = 0.0;  ///< [rad] body frame: rolling direction when driven forward
  /// [rad] from there to the axis of the roller on the ground: 0 for an omni wheel, which allows
  /// motion along its axle; +-45 degrees for a mecanum wheel.
  double rollers = 0.0;
};

/// The wheels of a holonomic base: forward, sideways and yaw are commanded independently.
/** The rim speed of wheel i is w_i = J_i (v_x, v_y, omega). With p its contact and g the direction
 * of its rollers' axis, both in the body frame:
 *
 *     J_i = (g_x, g_y, p_x g_y - p_y g_x) / cos(rollers)
 *
 * The inverse is by least squares, because more than three wheels can contradict each other. */
class OmniWheels {
 public:
  /// None: another vehicle.
  OmniWheels() = default;
  /// nullopt, and one line in `why`, for fewer than three wheels, more wheels than command
  /// channels, or wheels that do not span forward, sideways and yaw motion.
  static std::optional<OmniWheels> make(std::vector<OmniWheel> wheels, std::string& why);

  bool empty() const { return wheels_.empty(); }
  size_t size() const { return wheels_.size(); }
  const std::vector<OmniWheel>& wheels() const { return wheels_; }
  /// Row J_i: rim speed [m/s] per forward [m/s], sideways [m/s] and yaw rate [rad/s].
  const Eigen::Vector3d& row(size_t wheel) const { return rows_[wheel]; }

  /// Rim speeds [m/s] of a body twist.
  Command speeds(const Twist2& v_body) const;
  /// Body twist of rim speeds [m/s].
  Twist2 twist(const Command& speeds) const;

  /// [m] of the farthest wheel from the body origin.
  double radius() const;
  /// [1] largest speed of a point at that radius, over the largest rim speed.
  double reach() const;

 private:
  std::vector<OmniWheel> wheels_;
  std::vector<Eigen::Vector3d> rows_;     ///< J_i
  std::vector<Eigen::Vector3d> columns_;  ///< of the pseudo-inverse of J
};

/// Channels of a holonomic base's commands, in the whole range of a kind: wheel1, wheel2, ...
CommandChannels omniChannels(CommandKind kind, size_t wheels);

}  // namespace tread
