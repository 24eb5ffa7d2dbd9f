// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/log/event_log.hpp"
#include "common/pattern/pattern.hpp"
#include "common/vehicle/model.hpp"

namespace tread::replay {

/// (run id, execution id).
using ExecutionKey = std::pair<int64_t, int64_t>;

/// What the learner reads of a log, in order of time, and what a report needs beside it.
struct DriveLog {
  std::string name;              ///< file name without folder and ending
  std::vector<LogEvent> events;  ///< INS, EXECUTION and MOTOR
  std::vector<execution_record_t>
      executions;  ///< those that ended, each once, in order of their end
  std::map<ExecutionKey, std::map<int32_t, TrackCommand>> commands;  ///< by index, as applied
  std::map<int64_t, std::string> surfaces;  ///< from when [us] on: MARK surface
  CommandKind kind = CommandKind::kTrackSpeed;
  int64_t skipped = 0;  ///< events on these channels that are of other types
  std::string problem;  ///< one clear line if the log is damaged; what is whole was read

  /// The surface at a time; "unknown" before the first mark.
  std::string surfaceAt(int64_t utime) const;
};

/// Takes the events of a drive; `name` stands for the log in reports.
DriveLog toDriveLog(const std::string& name, std::vector<LogEvent> events);

/// Reads a log file; throws std::runtime_error with one clear line if nothing in it can be
/// replayed.
DriveLog readDriveLog(const std::string& path);

/// One pattern for each pattern id among the completed executions of a log, predicted by a model:
/// the commands that were applied in the first of them, entered in the steady motion of their first
/// command.
/** Throws std::runtime_error with one clear line if the log's commands are not of the model's kind.
 */
PatternSet predictedSet(const DriveLog& log, const VehicleModel& model);

}  // namespace tread::replay
