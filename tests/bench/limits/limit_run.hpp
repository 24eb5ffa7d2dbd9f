// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "tests/bench/limits/limit_world.hpp"
#include "tools/lab/missions/robot_system.hpp"

namespace tread::limits {

/// Result of one mission, by the true pose every 5 ms.
struct LimitRun {
  bool drove = false;
  bool arrived = false;
  double seconds = 0.0;   ///< until it arrived, was refused, or the time limit
  double distance = 0.0;  ///< [m]
  /// [m] least distance of the true outline to a fence that it was inside of
  double least_room = 1e9;
  double farther_out = 0.0;  ///< [m] by which a robot outside of a fence went farther out
  double tilt = 0.0;         ///< [rad] largest roll or pitch
  double inclination = 0.0;  ///< [rad] steepest ground under the robot
  int fence_stops = 0;       ///< by the motor bridge
  int tilt_stops = 0;
  std::string last_plan;  ///< the planner's status in words
};

/// Rules to disable, for tests that must detect it.
struct LimitOptions {
  double seconds = 60.0;
  bool bridge_watches = true;
  bool planner_keeps_off = true;
};

LimitRun runLimits(const missions::RobotConfig& robot, uint64_t seed, const LimitWorld& world,
                   const LimitOptions& options);

}  // namespace tread::limits
