// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "tools/lab/replay/learner_replay.hpp"

namespace tread::replay {

/// Mean and median of one kind of error.
struct ErrorSummary {
  size_t count = 0;
  double position_mean = 0.0;    ///< [m]
  double position_median = 0.0;  ///< [m]
  double yaw_mean = 0.0;         ///< [rad] of the absolute error
  double yaw_median = 0.0;       ///< [rad]
};

/// Over the executions whose end was measured and scored.
ErrorSummary summarise(const std::vector<learning_t>& learned);

/// forward, forward turn, counter-rotating, reverse turn, reverse or standing: what a series asks
/// for.
std::string commandClass(const MotionPattern& pattern, const CommandChannels& channels);

/// The report over a log: executions in, measured, refused with reasons; errors by surface and by
/// class of command, with the runs side by side. The first run is the one the others are compared
/// with.
std::string reportOf(const DriveLog& log, const PatternSet& set,
                     const std::vector<LearnerRun>& runs);

/// The same as a picture; throws std::runtime_error with one clear line if it cannot be written.
void drawReport(const DriveLog& log, const PatternSet& set, const std::vector<LearnerRun>& runs,
                const std::string& path);

}  // namespace tread::replay
