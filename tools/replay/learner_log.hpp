// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/log/drive_log.hpp"
#include "common/pattern/pattern.hpp"
#include "common/vehicle/model.hpp"

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

}  // namespace tread::replay
