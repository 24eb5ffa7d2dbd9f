// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/config/config_reader.hpp"
#include "common/pattern/pattern.hpp"
#include "common/recordings/recordings.hpp"
#include "common/vehicle/model.hpp"
#include "common/vehicle/model_document.hpp"

namespace tread::patterns {

/// Makes a pattern set from a recipe (see config/patterns/recipes): commands from the recipe,
/// predictions from the model.
/** Ids count from 1 in the order of the recipe; `mirror` adds the pattern with left and right
 * exchanged. Predictions are rounded to micrometres and microradians. Throws ConfigError at
 * file:line for what the recipe gets wrong; among that is a pattern that does not hold its exit
 * class's steady command for three lags (and the delay) at its end. */
PatternSet makeSet(ConfigReader recipe, const VehicleModel& model);

/// The command that a row of a recipe stands for: left and right, throttle and steering, or of a
/// holonomic base its twist.
Command commandOf(const VehicleModel& model, const std::vector<double>& row);

/// How a model's executions are measured.
struct ModelRecording {
  int executions = 30;     ///< of each pattern
  double position = 3e-3;  ///< [m] standard deviation of each sample's x and y
  double yaw = 1e-3;       ///< [rad]
  uint64_t seed = 1;
};

/// Throws std::runtime_error if a set commands another kind than a model's.
void requireSameKind(const PatternSet& set, const VehicleModel& model);

/// Executes each pattern of a set on a vehicle model, entered in the steady motion of its entry
/// class, with the model's spread and INS noise on each sample; the start is known without error.
/** What the model says of the INS (late, askew, biased) is in what is recorded, of the start, too;
 * it measures from three seconds before the pattern on. Each pattern on each surface has a random
 * series of its own, by its id and the surface's name: other patterns and their order change
 * nothing. Throws std::runtime_error if the set commands another kind than the model's. */
recordings::SurfaceRecordings recordModel(const PatternSet& set, const ModelDocument& model,
                                          const std::string& surface, const ModelRecording& how);

/// Largest motions of a model that drives each pattern of a set, entered in its class's steady
/// motion.
Envelope envelopeOf(const VehicleModel& model, const PatternSet& set);

/// Warns on stderr, a line each, of what a set asks of a model that it was not made from; silent
/// where the model's file has no envelope.
/** Throws std::runtime_error if the set commands another kind than the model's. */
void warnOutside(const ModelDocument& document, const std::string& model_file,
                 const PatternSet& set);

}  // namespace tread::patterns
