// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "tools/missions/mission.hpp"

namespace tread::missions {

/// Prediction error of a measured execution in the world with a seed; nothing if there is none.
using ErrorOf =
    std::function<std::optional<shadow::PredictionError>(const ScoredExecution&, uint64_t seed)>;

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

/// Errors around changes of surface, each mean over the executions of all changes.
struct ErrorsAroundChanges {
  MeanError before;   ///< the last five executions on the old surface
  MeanError after;    ///< the first three on the new one
  MeanError settled;  ///< the fifth to the fifteenth
};

/// Measured executions that lie wholly on one stretch of surface: after crossing `index` - 1,
/// before crossing `index`; 0 = before the first.
std::vector<const ScoredExecution*> stretchOf(const MissionResult& result, size_t index);

/// Of one change, an index into crossings, as driven.
ErrorsAroundChanges errorsAroundChange(const MissionResult& result, size_t change);

/// Of all changes of all missions.
ErrorsAroundChanges errorsAroundChanges(const std::vector<MissionResult>& results,
                                        const ErrorOf& error);

/// Over all measured executions that lie wholly on one surface.
MeanError meanErrorOf(const std::vector<MissionResult>& results, const ErrorOf& error);

/// After changes between two surfaces; from "start" = before the first change.
struct ErrorAfterChange : MeanError {
  std::string from;
  std::string to;
};

/// Of the executions with index first..last after each change of surface (1 = the first whole one
/// after it), as driven. Per pair of surfaces, sorted by name, pooled over all missions.
std::vector<ErrorAfterChange> errorsAfterChange(const std::vector<MissionResult>& results,
                                                int first, int last);

}  // namespace tread::missions
