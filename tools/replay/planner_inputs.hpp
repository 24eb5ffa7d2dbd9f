// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/bus/bus.hpp"
#include "modules/planner/planner_config.hpp"
#include "tools/replay/robot_log.hpp"

namespace tread::replay {

/// A message that a planner can take in: where it stands in the log, and what it says it is.
struct PlannerInput {
  size_t event = 0;
  Receipt receipt;
};

/// The log's messages that a planner takes in, in the order of the log: those on its channels that
/// can be decoded.
std::vector<PlannerInput> plannerInputs(const RobotLog& log, const planner::PlannerConfig& config);

/// A step of a planner that the log tells of.
struct ToldStep {
  program_t program;
  bool lost = false;  ///< the log lacks its PROGRAM: only `utime` is known, and only about
};

/// Which messages of the log a planner had taken in before each of its steps.
struct Hearing {
  std::vector<PlannerInput> inputs;  ///< in the order in which the planner heard them
  size_t from = 0;                   ///< the first of them that it heard
  std::vector<size_t> until;         ///< by step: the first that it had not heard yet
  int64_t by_time = 0;    ///< steps whose newest message the log lacks: what they had heard is told
                          ///< by the time
  int64_t reordered = 0;  ///< pairs of messages that the recorder heard in the other order
  int64_t lacking = 0;    ///< messages that the planner had heard and the log lacks
  int64_t beyond = 0;     ///< messages of the log that the planner had not heard
};

/// Finds the newest message that each PROGRAM names (newest_input, its utime and seq) in the log.
/** On one host all hear in one order, but for pairs that come within microseconds: inputs_heard
 * shows those. It also tells where a planner began to hear, and what one of both has lost. */
Hearing hearingOf(const RobotLog& log, std::vector<PlannerInput> inputs,
                  const std::vector<ToldStep>& steps);

/// The same in a line.
std::string hearingLine(const Hearing& hearing);

}  // namespace tread::replay
