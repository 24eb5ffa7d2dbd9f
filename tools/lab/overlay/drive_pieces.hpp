// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/geometry/se2.hpp"
#include "common/soundness/core/drive.hpp"
#include "common/vehicle/model_document.hpp"

namespace tread::overlay {

/// Reads LCM logs that are parts of one recording, in order, as tread-gap does.
/** `problem`: damage of the log in one line; empty if none. Throws std::runtime_error with one
 * clear line if a log cannot be read, if MOTOR or INS is missing, or if nothing was driven. */
gap::Drive readLoggedDrive(const std::vector<std::string>& logs, std::string& problem);

inline constexpr double kSample = 0.1;  ///< [s] between the poses of a piece

/// A piece of a drive: the measurement, and each model's prediction for the same commands from the
/// measured start. Poses are relative to the start, at 0, kSample, 2 kSample, ...
struct ComparedPiece {
  double begin = 0.0;  ///< [s] of the drive
  std::vector<Pose2> measured;
  std::vector<std::vector<Pose2>> predicted;  ///< by model

  double positionError(size_t model, size_t sample) const;  ///< [m]
  double yawError(size_t model, size_t sample) const;       ///< [rad]
};

/// Cuts a drive into pieces of a length [s], and leaves out those with little motion, an INS gap
/// above 0.3 s, or a segment (see Drive) that begins less than 3 s before them.
/** Each model simulates its segment from the beginning, which initializes its tracks and delays. It
 * gets slopes and battery from the log, and its INS part is applied to its poses. Throws
 * std::runtime_error if the models need another kind of command. */
std::vector<ComparedPiece> replay(const gap::Drive& drive, const std::vector<ModelDocument>& models,
                                  double length);

/// A model's median errors over the pieces at a sample: [m] and [rad].
struct MedianErrors {
  double position = 0.0;
  double yaw = 0.0;
};
MedianErrors medianErrors(const std::vector<ComparedPiece>& pieces, size_t model, size_t sample);

/// Draws six pieces, evenly distributed over the drive, as measured and by model, and the growth of
/// the models' median errors.
/** Throws std::runtime_error with one clear line if the file cannot be written. */
void drawOverlay(const std::string& path, const std::string& title,
                 const std::vector<ComparedPiece>& pieces,
                 const std::vector<std::string>& model_names);

}  // namespace tread::overlay
