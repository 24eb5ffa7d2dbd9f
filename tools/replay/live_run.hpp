// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "tools/replay/learner_replay.hpp"
#include "tools/replay/robot_log.hpp"

namespace tread::replay {

/// A log that lcm-logplayer played to a running learner, against its virtual replay.
struct LiveComparison {
  std::string name;        ///< of the recording of the run
  int64_t executions = 0;  ///< reported by the virtual replay
  int64_t reported = 0;    ///< of these, by the running learner
  int64_t equal = 0;       ///< of these, with the same verdict, measurement and errors, to the bit
  int64_t accepted = 0;    ///< measured in the virtual replay
  int64_t accepted_live = 0;  ///< and by the running learner
  int64_t heard = 0;          ///< messages that the process counted (HEALTH)
  int64_t played = 0;         ///< messages for it in the played log
  int64_t lost = 0;           ///< that it knows to have lost, by seq (HEALTH)
  std::string first_difference;

  /// Whether the running learner reported what the virtual replay does, of all executions.
  bool sameReports() const { return executions > 0 && equal == executions; }
};

/// Compares a recording of the run (lcm-logger) with runLearner() on the played log, with
/// Commitment::kRecorded and the rule of the process. Versions are not compared: their numbers come
/// from the start of the process.
LiveComparison compareLive(const RobotLog& run, const DriveLog& played,
                           const LearnerRun& virtual_run);

/// The counts, and what was lost, in a few lines.
std::string reportOf(const LiveComparison& comparison);

}  // namespace tread::replay
