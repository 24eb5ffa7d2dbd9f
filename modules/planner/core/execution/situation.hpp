// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "modules/planner/core/map/cost_to_go.hpp"
#include "modules/planner/core/search/search.hpp"

namespace tread::planner {

/// Where the vehicle was measured to be.
struct PoseReading {
  int64_t utime = 0;  ///< [us] of the measurement
  Pose2 T_map_body;
  std::optional<Twist2> twist;  ///< v_body, if it is measured
};

/// What the motor bridge says it does.
struct BridgeReading {
  enum class State { kDisarmed, kArmed, kDriving, kStopping, kFault, kEstopped };
  int64_t utime = 0;  ///< [us] when it gave its last command
  State state = State::kDisarmed;
  std::string reason;
  int64_t run_id = 0;
  int64_t execution_id = 0;  ///< being played; 0 = none
  int command_index = -1;

  /// It may drive without being armed anew.
  bool armed() const {
    return state == State::kArmed || state == State::kDriving || state == State::kStopping;
  }
};

/// One execution as the motor bridge keeps it.
struct ExecutionReading {
  enum class Outcome { kRunning, kCompleted, kAborted };
  int64_t run_id = 0;
  int64_t execution_id = 0;
  int64_t started = 0;  ///< [us]
  int64_t ended = -1;   ///< [us]; -1 = still running
  Outcome outcome = Outcome::kRunning;
  std::string reason;  ///< why aborted
};

/// Everything the planner knows at one moment, apart from map and patterns.
struct Situation {
  int64_t now = 0;  ///< [us]
  std::optional<PoseReading> pose;
  std::optional<BridgeReading> bridge;
  std::vector<ExecutionReading> executions;  ///< the last ones, oldest first
  std::optional<Goal> goal;
  bool armed_by_operator =
      false;  ///< ARM was seen since the start and since the last stop that needs it
  bool estopped = false;
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

}  // namespace tread::planner
