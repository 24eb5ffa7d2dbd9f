// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "tools/lab/missions/robot_system.hpp"

namespace tread::faults {

/// What came of a mission whose operator falls silent for good while the robot drives.
struct ReturnRun {
  bool lost = false;            ///< the operator was lost while it drove
  double away = 0.0;            ///< [m] from where its way began, at that moment
  double missed_link = 0.0;     ///< [m] nearest to the last place at which the operator was there
  double missed_start = 0.0;    ///< [m] from where its way began, at the end
  double returned_after = 0.0;  ///< [s] from the loss until it was within 1 m of that; 0 = never
  int collisions = 0;           ///< after the loss
  bool moved_at_end = false;    ///< the motors still turned at the end
  std::string state;            ///< the planner's last word
};

/// The operator of a mission is lost at a drawn moment; `lost: go_back` is set here.
ReturnRun runReturn(missions::RobotConfig robot, uint64_t seed);

}  // namespace tread::faults
