// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/recordings/recordings.hpp"
#include "common/vehicle/model.hpp"

namespace tread::experiment {

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

}  // namespace tread::experiment
