// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "tests/bench/limits/limit_world.hpp"
#include "tools/lab/missions/robot_system.hpp"

namespace tread::limits {

/// What one mission came to, judged by the true pose of the simulated robot every 5 ms.
struct LimitRun {
  bool drove = false;
  bool arrived = false;
  double seconds = 0.0;      ///< until it arrived, was refused, or the time was over
  double distance = 0.0;     ///< [m]
  double least_room = 1e9;   ///< [m] of the true outline to a fence that it was within
  double farther_out = 0.0;  ///< [m] by which a robot over a fence went farther out, at most
  double tilt = 0.0;         ///< [rad] roll or pitch, at most
  double inclination = 0.0;  ///< [rad] of the ground that it stood on, at most
  int fence_stops = 0;       ///< by the motor bridge
  int tilt_stops = 0;
  std::string last_plan;  ///< the planner's status in words
};

/// Which rules are left out, for tests that must see them go.
struct LimitOptions {
  double seconds = 60.0;
  bool bridge_watches = true;
  bool planner_keeps_off = true;
};

LimitRun runLimits(const missions::RobotConfig& robot, uint64_t seed, const LimitWorld& world,
                   const LimitOptions& options);

}  // namespace tread::limits
