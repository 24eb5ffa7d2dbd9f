// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/recordings/recordings.hpp"

namespace tread::recordings {

/// Executions of one pattern that averaging left out, and why.
struct AverageNote {
  std::string pattern;
  int used = 0;
  bool by_twist = false;  ///< body twists were averaged, not poses, because the turn is strong
  std::vector<std::string> rejected;  ///< a line for each execution that was left out
  std::vector<size_t> left_out;       ///< the same executions by index, from 0
};

/// When an execution is invalid, and how many valid ones are needed.
struct AverageLimits {
  double strong_turn = 0.5;  ///< [rad] from here on twists are averaged
  double max_speed = 0.0;    ///< [m/s] of a step, over 0.1 s; 0 = 1.5 times the median's largest
  int min_executions = 3;    ///< fewer valid ones are refused
};

/// IP_S: the set with averaged trajectories and the recorded spread of each end as its covariance.
/** Strong turns are averaged as body twists sample by sample, because the mean of such poses is
 * shorter than each of them. The spread is about the mean of the end poses (n - 1). An execution
 * of another length, with a number that is not finite, an impossible speed or a jump of yaw is
 * left out and noted, one note per pattern in the order of the set. Name, version and classes
 * stay; times_learned is 0. Throws RecordingError if a pattern has too few executions. */
PatternSet averageSet(const PatternSet& patterns, const SurfaceRecordings& recordings,
                      const AverageLimits& limits, std::vector<AverageNote>& notes);

}  // namespace tread::recordings
