// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "modules/planner/planner_config.hpp"
#include "tools/replay/robot_log.hpp"

namespace tread::replay {

/// The log of a robot's drive through the planner: what it holds, what came out, how they compare.
/** The planner steps when the log's planner did (utime of PROGRAM) and has then heard what that one
 * had heard (newest_input, inputs_heard). Searches end by a count of expansions: the configured
 * one, or that of the log's PLAN where the deadline cut the search on the robot. Compared per step,
 * to the bit: PROGRAM and PLAN without seq and search_time. */
struct PlannerCheck {
  std::string name;
  int lives = 0;     ///< planners in the log
  int compared = 0;  ///< of these, those whose start the log holds; the others cannot be compared
  int64_t steps = 0;
  int64_t searches_cut = 0;  ///< by the deadline on the robot
  int64_t programs_equal = 0;
  int64_t programs_different = 0;
  int64_t plans_equal = 0;
  int64_t plans_different = 0;
  int64_t plans_only_in_log = 0;
  int64_t plans_only_in_replay = 0;
  int64_t plans_lost = 0;        ///< PLANs that the log lacks, by seq
  std::string first_difference;  ///< in words; empty = none
  int64_t lacking = 0;           ///< messages that the planners had heard and the log lacks
  bool same_twice = true;        ///< a second replay published the same bytes
  std::vector<std::string> notes;

  /// Whether the replay says what the log says, and says it twice. Of the PLANs that only the
  /// replay has the recorder lost as many as seq tells; nothing compared is not equal.
  bool equal() const {
    return same_twice && programs_equal > 0 && programs_different == 0 && plans_different == 0 &&
           plans_only_in_log == 0 && plans_only_in_replay <= plans_lost;
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
