// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/pattern/pattern.hpp"
#include "common/recordings/recordings.hpp"
#include "modules/learner/core/trajectory_table.hpp"

namespace tread::experiment {

/// Where one execution ended, and what it covered on the way.
struct ExecutionEnd {
  Pose2 pose;            ///< last pose relative to the start, yaw unwrapped
  double metres = 0.0;   ///< length of the path from the start through all poses
  double radians = 0.0;  ///< |net yaw|
};

/// All executions of one pattern on one surface (RP_S), one behind the other in memory.
class Executions {
 public:
  /// All but those in `left_out`, indices in ascending order; the others have `samples` poses.
  Executions(const std::vector<recordings::Execution>& executions, size_t samples,
             const std::vector<size_t>& left_out);

  size_t size() const { return ends_.size(); }
  size_t samples() const { return samples_; }
  learner::ConstTrajectory of(size_t i) const {
    return {numbers_.data() + 3 * samples_ * i, static_cast<Eigen::Index>(samples_), 3};
  }
  const ExecutionEnd& endOf(size_t i) const { return ends_[i]; }

 private:
  size_t samples_;
  std::vector<double> numbers_;
  std::vector<ExecutionEnd> ends_;
};

/// One surface of an experiment.
struct Ground {
  std::string surface;
  PatternSet averaged;               ///< IP_S
  std::vector<Pose2> averaged_ends;  ///< of it, by pattern
  std::vector<Executions> executions;
};

ExecutionEnd executionEnd(const learner::ConstTrajectory& trajectory);

/// Averages a book surface by surface and lays its recordings out for the experiment.
/** Throws recordings::RecordingError with one line if a pattern has too few executions or there is
 * one surface only. What is no fair execution is neither averaged nor driven; a line for each goes
 * to `notes`. */
std::vector<Ground> groundsOf(const recordings::PatternRecordings& book,
                              std::vector<std::string>& notes);

}  // namespace tread::experiment
