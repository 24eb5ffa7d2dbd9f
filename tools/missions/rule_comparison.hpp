// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <optional>
#include <vector>

#include "tools/missions/mission.hpp"

namespace tread::missions {

/// Prediction error of a measured execution; nothing where there is none to speak of.
using ErrorOf = std::function<std::optional<shadow::EndError>(const ScoredExecution&)>;

/// Against the set that the planner had used.
ErrorOf errorAsDriven();
/// Against what the rule with this index in MissionResult::shadow_rules predicted.
ErrorOf errorByRule(size_t rule);

/// Errors of some executions.
struct MeanError {
  int count = 0;
  double position = 0.0;        ///< [m] mean
  double yaw = 0.0;             ///< [rad] mean of the absolute error
  double position_per_m = 0.0;  ///< pooled: sum of errors over metres driven
  double yaw_per_rad = 0.0;     ///< pooled: sum of errors over radians turned
};

/// Errors around all changes of surface together.
struct ErrorsAroundChanges {
  MeanError before;   ///< the last five executions on the old surface
  MeanError after;    ///< the first three on the new one
  MeanError settled;  ///< the fifth to the fifteenth
};

ErrorsAroundChanges errorsAroundChanges(const std::vector<MissionResult>& results,
                                        const ErrorOf& error);

/// Over all measured executions that lie wholly on one surface.
MeanError meanErrorOf(const std::vector<MissionResult>& results, const ErrorOf& error);

}  // namespace tread::missions
