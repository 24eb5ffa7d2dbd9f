// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/execution/readings.hpp"
#include "modules/planner/core/map/distance_to_goal.hpp"
#include "modules/planner/core/search/pattern_search.hpp"

namespace tread::planner {

/// Everything the planner knows at one moment, apart from map and patterns.
struct PlannerInputs : RobotReadings {
  std::optional<Goal> goal;
  int64_t set_received = 0;  ///< [us] when a part of a pattern set came last; 0 = never
};

/// How the planner stands to its goal; the numbers are those of plan_t.
enum class PlanStatus : int16_t {
  kIdle = 0,
  kDriving = 1,
  kArrived = 2,
  kWaiting = 3,
  kBlocked = 4,
  kUnreachable = 5,
  kStopped = 6
};

/// What the planner intends, for those who look on.
struct PlanReport {
  PlanStatus status = PlanStatus::kIdle;
  std::string reason;
  int64_t utime = 0;  ///< [us] of the pose it is based on
  int64_t goal_id = 0;
  int64_t set_version = 0;
  double time_to_go = 0.0;  ///< [s]; NaN unknown
  int expansions = 0;
  std::vector<int64_t> execution_ids;  ///< as many as steps; 0 = not yet given to the bridge
  std::vector<PlanStep> steps;
};

/// The limits of the inputs' ages [us].
struct AgeLimits {
  int64_t pose = 150'000;        ///< older: the program is emptied
  int64_t bridge = 500'000;      ///< older: the same
  int64_t map_slow = 2'000'000;  ///< older: no new patterns but one that stops
  int64_t map_stop = 5'000'000;  ///< older: the program is emptied
  int64_t pattern_set =
      5'000'000;  ///< older: the learner is lost, no new patterns but one that stops
};

/// Whether the inputs allow to drive.
struct Preconditions {
  enum class Level {
    kGo,
    kFinish,  ///< no new pattern but one that stops
    kStop     ///< the program is emptied now
  };
  Level level = Level::kGo;
  PlanStatus status = PlanStatus::kDriving;  ///< to report if not kGo
  std::string reason;                        ///< in words, empty if kGo
};

/// What map and patterns are like, beside the inputs.
struct MapAndSet {
  int64_t map_utime = 0;                          ///< [us] of the newest scan in the map; 0 = none
  std::string set_defect = "no PATTERN_SET yet";  ///< why the set is of no use; empty = good
  bool was_armed = false;                         ///< the bridge was armed since the start
};

/// Judges the inputs: the worst of what is wrong decides.
Preconditions checkPreconditions(const PlannerInputs& inputs, const MapAndSet& supplies,
                                 const AgeLimits& limits);

}  // namespace tread::planner
