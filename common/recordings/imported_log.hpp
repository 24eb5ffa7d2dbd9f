// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <vector>

#include "common/log/drive_log.hpp"
#include "common/recordings/recorded_drive.hpp"

// Which executions a log gets. The recordings hold one command for six seconds and enter it at the
// speed of the one before. From `offset` on (delay and three time constants of the wheels later)
// the motion is nearly steady, and `executions` patterns of `length` follow one after the other:
// each is the same command series entered in its own steady motion. For the k-th command of a log
// (k = 1, 2, ...), the n-th of its executions has
//     execution id = 10 k + n,   pattern id = the recording's step number,   set version 1,   run
//     id 1.
// A command that did not last until the end of an execution leaves it aborted, with the reason.
namespace tread::recordings {

struct ExecutionLayout {
  double offset = 1.2;  ///< [s] from the first sample with a command to its first execution
  double length = 2.0;  ///< [s]
  int executions = 2;   ///< per command, at most 9
};

/// What was put into a log.
struct LogCounts {
  size_t ins = 0;
  size_t motor = 0;
  size_t completed = 0;
  size_t aborted = 0;
  double duration = 0.0;  ///< [s]
};

/// The events of the log of a recording in order of time: MARK, CONFIG, INS, MOTOR, EXECUTION.
/// utime 0 is one second before the recording's time 0.
std::vector<LogEvent> makeLog(const RecordedDrive& recording, const Session& session,
                              const std::string& format, const ExecutionLayout& layout,
                              LogCounts& counts);

}  // namespace tread::recordings
