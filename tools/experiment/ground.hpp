// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <random>
#include <string>
#include <vector>

#include "common/pattern/pattern.hpp"
#include "common/recordings/recordings.hpp"
#include "common/vehicle/model.hpp"
#include "modules/learner/core/scaling.hpp"

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

/// Averages a set of recordings surface by surface and lays its recordings out for the experiment.
/** Throws recordings::RecordingError with one line if a pattern has too few executions or there is
 * one surface only. What is no fair execution is neither averaged nor driven; a line for each goes
 * to `notes`. */
std::vector<Ground> groundsOf(const recordings::PatternRecordings& recorded,
                              std::vector<std::string>& notes);

/// One surface of a world: the vehicle on it.
struct WorldSurface {
  std::string name;
  VehicleModel model;
};

/// A pattern to execute: commands sample by sample.
struct WorldPattern {
  std::string name;
  std::vector<TrackCommand> commands;
};

/// A simulated vehicle on several surfaces, of which recordings can be made (config/worlds, kind:
/// transitions).
struct TransitionWorld {
  std::string name;
  bool paper_reference = false;  ///< the paper's numbers stand beside where surfaces are its own
  TrackCommand entry{1.0, 1.0};  ///< [1] each pattern begins in the steady motion of this command
  double period = 0.05;          ///< [s] a sample
  int64_t recordings = 300;      ///< executions of each pattern on each surface
  double position_noise = 0.0;  ///< [m] of the INS, standard deviation of x and of y of each sample
  double yaw_noise = 0.0;       ///< [rad]
  std::vector<WorldPattern> patterns;
  std::vector<std::vector<std::string>> sequences;  ///< names of patterns
  std::vector<WorldSurface> surfaces;
};

/// Throws ConfigError with one line "file:line: what is wrong; what is allowed".
TransitionWorld readTransitionWorld(const std::string& path);
/// The same from text; `name` stands for the file in messages.
TransitionWorld parseTransitionWorld(const std::string& text, const std::string& name);

/// Executes each pattern on each surface and measures it. Each command is held `length` times as
/// long. Same seed, same recordings.
recordings::PatternRecordings record(const TransitionWorld& world, uint64_t seed, int length = 1);

/// One of `count` things, drawn by chance; the same on every machine.
inline size_t drawIndex(std::mt19937_64& random, size_t count) {
  return static_cast<size_t>(((random() >> 32) * static_cast<uint64_t>(count)) >> 32);
}

/// A seed of its own for each combination of numbers (splitmix64 over all of them).
inline uint64_t seedOf(std::initializer_list<uint64_t> numbers) {
  uint64_t state = 0;
  for (const uint64_t number : numbers) {
    state += number + 0x9E3779B97F4A7C15ULL;
    state = (state ^ (state >> 30)) * 0xBF58476D1CE4E5B9ULL;
    state = (state ^ (state >> 27)) * 0x94D049BB133111EBULL;
    state ^= state >> 31;
  }
  return state;
}

}  // namespace tread::experiment
