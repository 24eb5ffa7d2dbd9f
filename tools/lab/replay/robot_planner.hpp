// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>

#include "common/drive/robot_log.hpp"
#include "modules/planner/core/execution/driving_state.hpp"
#include "tools/lab/replay/replay_check.hpp"

namespace tread::replay {

/// A robot's log through the planner.
/** The planner steps at the times of the log's planner (utime of PROGRAM), with the messages
 * received by then (newest_input, inputs_heard). Searches end by a count of expansions: the
 * configured one, or that of the log's PLAN where the deadline cut the search on the robot.
 * Compared per step, to the bit: PROGRAM and PLAN without seq and search_time. */
struct PlannerCheck : ReplayCheck {
  int compared = 0;  ///< lives that begin in the log; the others cannot be compared
  int64_t steps = 0;
  int64_t searches_cut = 0;  ///< by the robot's deadline
  MessageCounts programs;
  MessageCounts plans;
  int64_t plans_lost = 0;  ///< PLANs missing in the log, by seq
  int64_t lacking = 0;     ///< messages that the planners had received and the log lacks

  /// Whether both replays published the messages of the log. PLANs only in the replay may be as
  /// many as the recorder lost by seq. If nothing was compared the result is false.
  bool equal() const {
    return same_twice && programs.equal > 0 && programs.different == 0 && plans.different == 0 &&
           plans.only_in_log == 0 && plans.only_in_replay <= plans_lost;
  }
};

/// Replays the log twice and compares. Throws std::runtime_error with one clear line if the log has
/// no PROGRAM.
PlannerCheck checkPlanner(const RobotLog& log, const planner::PlannerConfig& config);

/// A few lines of text.
std::string reportOf(const PlannerCheck& check);

}  // namespace tread::replay
