// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/geometry/se2.hpp"
#include "common/pattern/command.hpp"
#include "common/pattern/pattern.hpp"
#include "common/recordings/recordings.hpp"
#include "common/vehicle/model.hpp"
#include "modules/learner/core/scaling.hpp"

namespace tread::experiment {

/// End of one execution, with its path length and turn.
struct ExecutionEnd {
  Pose2 pose;            ///< last pose relative to the start, yaw unwrapped
  double metres = 0.0;   ///< length of the path from the start through all poses
  double radians = 0.0;  ///< absolute net yaw
};

/// All executions of one pattern on one surface (RP_S), contiguous in memory.
class Executions {
 public:
  /// Each has `samples` poses.
  Executions(const std::vector<recordings::Execution>& executions, size_t samples);

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

/// One surface of an experiment. Test recordings are never averaged nor driven before.
struct TrialGround {
  std::string surface;
  PatternSet averaged;               ///< IP_S, from one half of the recordings
  std::vector<Pose2> averaged_ends;  ///< its ends, by pattern
  std::vector<Executions> known;     ///< the same half, used by excitation runs
  std::vector<Executions> tests;     ///< the other half
};

ExecutionEnd executionEnd(const learner::ConstTrajectory& trajectory);

/// Splits the recordings of each pattern in two halves, averages one by surface, and arranges both
/// for the experiment.
/** Neighbours stay together: recordings from drives come in pairs from one step, which share a
 * local mean. Throws recordings::RecordingError with one line if a pattern has fewer than eight
 * valid executions or there is only one surface. Invalid executions are left out; `notes` gets a
 * line for each, and one if recordings are few. */
std::vector<TrialGround> groundsOf(const recordings::PatternRecordings& recorded,
                                   std::vector<std::string>& notes);

/// One surface of a world: the vehicle's model on it.
struct WorldSurface {
  std::string name;
  VehicleModel model;
};

/// A pattern to execute: commands per sample.
struct WorldPattern {
  std::string name;
  std::vector<TrackCommand> commands;
};

/// A simulated vehicle on several surfaces, for making recordings (config/worlds, kind:
/// transitions).
struct TransitionWorld {
  std::string name;
  bool paper_reference = false;  ///< print the paper's numbers for surfaces that it has
  TrackCommand entry{1.0, 1.0};  ///< [1] each pattern begins in the steady motion of this command
  double period = 0.05;          ///< [s] a sample
  int64_t recordings = 300;      ///< executions of each pattern on each surface
  double position_noise = 0.0;   ///< [m] standard deviation of the INS for x and y of each sample
  double yaw_noise = 0.0;        ///< [rad]
  std::vector<WorldPattern> patterns;
  std::vector<std::vector<std::string>> sequences;  ///< names of patterns
  std::vector<WorldSurface> surfaces;
};

/// Throws ConfigError with one line "file:line: error; allowed values".
TransitionWorld readTransitionWorld(const std::string& path);
/// The same from text; `name` replaces the file in messages.
TransitionWorld parseTransitionWorld(const std::string& text, const std::string& name);

/// Executes each pattern on each surface and measures it. Each command is held `length` times as
/// long. The same seed gives the same recordings.
recordings::PatternRecordings record(const TransitionWorld& world, uint64_t seed, int length = 1);

/// Pattern indices in order of execution.
using Sequence = std::vector<size_t>;

/// Default test sequences: for the two patterns with the most distant ends, one twice followed by
/// the other, and the reverse.
/** Patterns that move in one dimension only are avoided if two others exist. An angle counts as its
 * arc at the mean distance of all ends. Empty if there is only one pattern. */
std::vector<Sequence> sequencesFor(const PatternSet& set);

}  // namespace tread::experiment
