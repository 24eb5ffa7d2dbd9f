// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/bus/bus.hpp"
#include "modules/planner/planner_config.hpp"
#include "tools/replay/robot_log.hpp"

namespace tread::replay {

/// A message for the planner: its place in the log, and its channel, utime and seq.
struct PlannerInput {
  size_t event = 0;
  Receipt receipt;
};

/// The log's messages on the planner's channels that can be decoded, in the order of the log.
std::vector<PlannerInput> plannerInputs(const RobotLog& log, const planner::PlannerConfig& config);

/// A step of the planner in the log.
struct LoggedStep {
  program_t program;
  bool lost = false;  ///< the log lacks its PROGRAM: only `utime` is known, and only about
};

/// The messages of the log that a planner had received before each of its steps.
struct Hearing {
  std::vector<PlannerInput> inputs;  ///< in the order in which the planner heard them
  size_t from = 0;                   ///< the first of them that it heard
  std::vector<size_t> until;         ///< by step: the first that it had not heard yet
  int64_t by_time = 0;               ///< steps whose newest message the log lacks: assigned by time
  int64_t reordered = 0;  ///< pairs of messages that the recorder heard in the other order
  int64_t lacking = 0;    ///< messages that the planner had heard and the log lacks
  int64_t beyond = 0;     ///< messages of the log that the planner had not heard
};

/// Finds the newest message that each PROGRAM names (newest_input, its utime and seq) in the log.
/** Processes on one host receive messages in the same order, except for pairs that arrive within
 * microseconds: inputs_heard reveals those. It also shows where a planner began to receive, and
 * messages that planner or recorder lost. */
Hearing hearingOf(const RobotLog& log, std::vector<PlannerInput> inputs,
                  const std::vector<LoggedStep>& steps);

/// The counts in one line.
std::string hearingLine(const Hearing& hearing);

}  // namespace tread::replay
