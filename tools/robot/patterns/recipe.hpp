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
 * file:line for errors in the recipe, for instance a pattern that does not hold its exit class's
 * steady command for three lags (and the delay) at its end. */
PatternSet makeSet(ConfigReader recipe, const VehicleModel& model);

/// Command of a recipe's row: left and right, throttle and steering, or a holonomic base's twist.
Command commandOf(const VehicleModel& model, const std::vector<double>& row);

/// How the executions of a model are measured.
struct ModelRecording {
  int executions = 30;     ///< of each pattern
  double position = 3e-3;  ///< [m] standard deviation of each sample's x and y
  double yaw = 1e-3;       ///< [rad]
  uint64_t seed = 1;
};

/// Throws std::runtime_error if set and model have different kinds of commands.
void requireSameKind(const PatternSet& set, const VehicleModel& model);

/// Executes each pattern of a set on a vehicle model, entered in the steady motion of its entry
/// class, with the model's spread and INS noise on each sample; the start pose is exact.
/** Recorded poses, including the start, contain the model's INS errors (latency, misalignment,
 * bias); the INS runs from three seconds before the pattern. Random numbers depend only on the
 * pattern's id and the surface's name, not on other patterns or their order. Throws
 * std::runtime_error if set and model have different kinds of commands. */
recordings::SurfaceRecordings recordModel(const PatternSet& set, const ModelDocument& model,
                                          const std::string& surface, const ModelRecording& how);

/// Largest motions while the model drives each pattern of a set, entered in its class's steady
/// motion.
Envelope envelopeOf(const VehicleModel& model, const PatternSet& set);

/// Warns on stderr, one line each, of patterns that exceed the motions from which the model was
/// made; silent if the model file has no envelope.
/** Throws std::runtime_error if set and model have different kinds of commands. */
void warnOutside(const ModelDocument& document, const std::string& model_file,
                 const PatternSet& set);

}  // namespace tread::patterns
