// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "tools/lab/missions/robot_system.hpp"

namespace tread::faults {

/// Result of a mission whose operator falls silent for good while the robot drives.
struct ReturnRun {
  bool lost = false;            ///< the operator was lost while it drove
  double away = 0.0;            ///< [m] from the start of its path, at that time
  double missed_link = 0.0;     ///< [m] closest approach to the last place with an operator
  double missed_start = 0.0;    ///< [m] from the start of its path, at the end
  double returned_after = 0.0;  ///< [s] from the loss until within 1 m of it; 0 = never
  int collisions = 0;           ///< after the loss
  bool moved_at_end = false;    ///< the motors still turned at the end
  std::string state;            ///< the planner's last reason
};

/// Loses the operator of a mission at a random time; sets `lost: go_back`.
ReturnRun runReturn(missions::RobotConfig robot, uint64_t seed);

}  // namespace tread::faults
