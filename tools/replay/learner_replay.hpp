// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/log/drive_log.hpp"
#include "common/pattern/pattern.hpp"
#include "common/vehicle/model.hpp"
#include "modules/learner/learner_node.hpp"

namespace tread::replay {

/// What the learner reads of a drive: only INS, MOTOR and EXECUTION events, in order of the
/// recorder's time; executions in order of their end. `name` stands for the log in reports.
DriveLog toLearnerLog(const std::string& name, std::vector<LogEvent> events);

/// Reads a log file, whose name without ending stands for it; throws std::runtime_error with one
/// clear line if nothing in it can be replayed.
DriveLog readLearnerLog(const std::string& path);

/// One pattern for each pattern id among the completed executions of a log, predicted by a model:
/// the commands that were applied in the first of them, entered in the steady motion of their first
/// command.
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
};

/// Feeds a log to the real learner node on the virtual bus, from an empty store. Deterministic.
LearnerRun runLearner(const DriveLog& log, const learner::LearnerNodeConfig& config,
                      Commitment commitment, const std::string& title);

}  // namespace tread::replay
