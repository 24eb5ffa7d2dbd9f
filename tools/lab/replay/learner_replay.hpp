// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/drive/drive_log.hpp"
#include "common/pattern/pattern.hpp"
#include "common/vehicle/model.hpp"
#include "modules/learner/learner_node.hpp"

namespace tread::replay {

/// The learner's inputs from a drive: INS, MOTOR and EXECUTION events in the robot's time,
/// executions ordered by their ends. `name` is the log's name in reports.
DriveLog toLearnerLog(const std::string& name, std::vector<LogEvent> events);

/// Reads a log file, named after the file without extension; throws std::runtime_error with one
/// clear line if it contains nothing to replay.
DriveLog readLearnerLog(const std::string& path);

/// One pattern for each pattern id among the completed executions of a log: the applied commands of
/// the first one, entered in the steady motion of its first command, with a model's prediction.
/** Throws std::runtime_error with one clear line if the log's commands are not of the model's kind.
 */
PatternSet predictedSet(const DriveLog& log, const VehicleModel& model);

/// Which set an execution is scored with.
enum class Commitment {
  kAhead,   ///< the newest when it began: what a planner knew, which commits to patterns early
  kPrompt,  ///< the newest when it ended: corrections of all executions before it are known
};

/// One run of the learner over a log.
struct LearnerRun {
  std::string title;
  std::vector<learning_t> learned;          ///< one per execution, in order of their end
  std::map<std::string, int64_t> counters;  ///< the last of HEALTH
  std::string health;                       ///< last line of HEALTH; empty if all is well
  std::optional<PatternSet> set;            ///< the last one
};

/// Feeds a log to the real learner node, from an empty store. Deterministic.
LearnerRun runLearner(const DriveLog& log, const learner::LearnerNodeConfig& config,
                      Commitment commitment, const std::string& title);

}  // namespace tread::replay
