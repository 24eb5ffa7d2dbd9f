// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "modules/planner/planner_config.hpp"
#include "tools/replay/replay_check.hpp"

namespace tread::replay {

/// A robot's log through the planner.
/** The planner steps when the log's planner did (utime of PROGRAM) and has then received what that
 * one had received (newest_input, inputs_heard). Searches end by a count of expansions: the
 * configured one, or that of the log's PLAN where the deadline cut the search on the robot.
 * Compared per step, to the bit: PROGRAM and PLAN without seq and search_time. */
struct PlannerCheck : ReplayCheck {
  int compared = 0;  ///< lives whose start the log holds; the others cannot be compared
  int64_t steps = 0;
  int64_t searches_cut = 0;  ///< by the deadline on the robot
  MessageCounts programs;
  MessageCounts plans;
  int64_t plans_lost = 0;  ///< PLANs that the log lacks, by seq
  int64_t lacking = 0;     ///< messages that the planners had received and the log lacks

  /// Whether both replays published what the log holds. Of the PLANs that only the replay has the
  /// recorder lost as many as seq shows; nothing compared is not equal.
  bool equal() const {
    return same_twice && programs.equal > 0 && programs.different == 0 && plans.different == 0 &&
           plans.only_in_log == 0 && plans.only_in_replay <= plans_lost;
  }
};

/// The planner's configuration as the log's CONFIG has it. Throws std::runtime_error with one clear
/// line.
planner::PlannerConfig plannerConfigOf(const RobotLog& log);

/// Replays the log twice and compares. Throws std::runtime_error with one clear line if the log
/// holds no PROGRAM.
PlannerCheck checkPlanner(const RobotLog& log, const planner::PlannerConfig& config);

/// A few lines of text.
std::string reportOf(const PlannerCheck& check);

}  // namespace tread::replay
