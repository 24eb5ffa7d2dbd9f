// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <vector>

#include "common/log/drive_log.hpp"
#include "common/recordings/recordings.hpp"

// Recordings as a robot would have sent them, so that the real learner process can hear them. First
// all executions on one surface, then those on the other; MARK names the surface. Each execution is
// a track of its own: INS and MOTOR tell of it from `lead` before its start to `tail` after its
// end, and are silent between two. The windows that the recordings come from are steady, so before
// its first and after its last pose the robot is taken to move by the mean twist of the recording
// (that of its first sample alone would be mostly noise of the lidar's poses).
//   INS        100 Hz; between two recorded poses by the constant twist that leads from one to the
//              other
//   MOTOR      20 Hz, the steady command; execution and index while the pattern is played
//   EXECUTION  on start and end, the last eight records; they name the version of the shipped set
// Units: m, rad, s.
namespace tread::recordings {

struct ExecutionLogRequest {
  int executions = 40;   ///< on each surface; patterns take turns in drawn order
  uint64_t seed = 1;     ///< draws that order, and which recordings are played
  double lead = 0.5;     ///< [s]
  double tail = 0.3;     ///< [s]
  double silence = 1.0;  ///< [s] between two executions
};

/// The log; `shipped` is the set that the executions name, with the patterns of the recordings.
/** Throws RecordingError if they do not fit. Same arguments, same bytes. */
std::vector<LogEvent> executionLog(const PatternSet& shipped, const SurfaceRecordings& from,
                                   const SurfaceRecordings& to, const ExecutionLogRequest& request);

}  // namespace tread::recordings
