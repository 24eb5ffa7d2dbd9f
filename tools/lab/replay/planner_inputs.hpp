// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/bus/bus.hpp"
#include "common/drive/robot_log.hpp"
#include "modules/planner/core/execution/driving_state.hpp"

namespace tread::replay {

/// A message to the planner: its place in the log, and its channel, utime and seq.
struct PlannerInput {
  size_t event = 0;
  Receipt receipt;
};

/// The decodable messages on the planner's channels, in the order of the log.
std::vector<PlannerInput> plannerInputs(const RobotLog& log, const planner::PlannerConfig& config);

/// A step of the planner in the log.
struct LoggedStep {
  program_t program;
  bool lost = false;  ///< the log lacks its PROGRAM: only an approximate `utime` is known
};

/// The messages in the log that a planner had received before each of its steps.
struct Hearing {
  std::vector<PlannerInput> inputs;  ///< in the order of reception
  size_t from = 0;                   ///< the first one received
  std::vector<size_t> until;         ///< by step: the first one not yet received
  int64_t by_time = 0;               ///< steps without a known newest message: assigned by time
  int64_t reordered = 0;  ///< pairs of messages that the recorder received in the opposite order
  int64_t lacking = 0;    ///< messages received by the planner but missing in the log
  int64_t beyond = 0;     ///< messages in the log that the planner did not receive
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
