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
/** `problem`: one clear line of what is wrong with the log; empty if nothing is. Throws
 * std::runtime_error with one clear line if a log cannot be read, if MOTOR or INS is not in them,
 * or if nothing was driven. */
gap::Drive readLoggedDrive(const std::vector<std::string>& logs, std::string& problem);

inline constexpr double kSample = 0.1;  ///< [s] between the poses of a piece

/// A piece of a drive: what was measured, and what models make of the same commands from the
/// measured pose at its beginning on. Poses relative to that one, at 0, kSample, 2 kSample, ...
struct ComparedPiece {
  double begin = 0.0;  ///< [s] of the drive
  std::vector<Pose2> measured;
  std::vector<std::vector<Pose2>> predicted;  ///< by model

  double positionError(size_t model, size_t sample) const;  ///< [m]
  double yawError(size_t model, size_t sample) const;       ///< [rad]
};

/// The drive in pieces of a length [s], without those in which the vehicle hardly moved, the INS
/// was silent for more than 0.3 s, or that a segment (see Drive) begins less than 3 s before.
/** A model drives from the beginning of its segment on, so that its tracks and delays are under
 * way; it knows slopes and battery as the log does, and its INS part is between it and what is
 * compared.
 * Throws std::runtime_error if the models take another kind of command than was given. */
std::vector<ComparedPiece> replay(const gap::Drive& drive, const std::vector<ModelDocument>& models,
                                  double length);

/// Median over the pieces of the errors of a model at a sample: [m] and [rad].
struct MedianErrors {
  double position = 0.0;
  double yaw = 0.0;
};
MedianErrors medianErrors(const std::vector<ComparedPiece>& pieces, size_t model, size_t sample);

/// Draws six pieces, evenly chosen over the drive, as measured and by model, and how the models'
/// median errors grow.
/** Throws std::runtime_error with one clear line if the file cannot be written. */
void drawOverlay(const std::string& path, const std::string& title,
                 const std::vector<ComparedPiece>& pieces,
                 const std::vector<std::string>& model_names);

}  // namespace tread::overlay
