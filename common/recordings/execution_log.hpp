// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/recordings/recordings.hpp"

namespace tread::recordings {

struct ExecutionLogRequest {
  int executions = 40;   ///< on each surface; patterns alternate in a random order
  uint64_t seed = 1;     ///< seed of that order and of the choice of recordings
  double lead = 0.5;     ///< [s]
  double tail = 0.3;     ///< [s]
  double silence = 1.0;  ///< [s] between two executions
};

/// The log; `shipped` is the set that the executions name, with the patterns of the recordings.
/** Throws RecordingError if they do not match. Deterministic: same arguments, same bytes. */
std::vector<LogEvent> executionLog(const PatternSet& shipped, const SurfaceRecordings& from,
                                   const SurfaceRecordings& to, const ExecutionLogRequest& request);

}  // namespace tread::recordings
