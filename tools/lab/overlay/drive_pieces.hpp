// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/geometry/se2.hpp"
#include "common/vehicle/model_document.hpp"

namespace tread::overlay {

/// A command that was on the motors from a time until the next one.
struct GivenCommand {
  double time = 0.0;  ///< [s] since the first MOTOR message
  TrackCommand command;
  double battery_drop = 0.0;  ///< [1] relative fall of the voltage since then; 0 = not measured
};

/// An INS measurement.
struct MeasuredPose {
  double time = 0.0;   ///< [s] since the first MOTOR message
  Pose2 T_map_body;    ///< yaw unwrapped
  double roll = 0.0;   ///< [rad] left side up positive
  double pitch = 0.0;  ///< [rad] nose down positive
};

/// What was commanded and what was measured, in the order of time.
struct LoggedDrive {
  std::vector<CommandKind> kinds;  ///< of the channels of its commands
  std::vector<GivenCommand> commands;
  std::vector<MeasuredPose> track;
  std::string problem;  ///< one clear line of what is wrong with the log; empty if nothing is
};

/// Reads MOTOR and INS of LCM logs that are parts of one recording, in order.
/** Throws std::runtime_error with one clear line if a log cannot be read, or if one of the two
 * channels is not in them, or if nothing was driven. */
LoggedDrive readLoggedDrive(const std::vector<std::string>& logs);

inline constexpr double kSample = 0.1;  ///< [s] between the poses of a piece

/// A piece of a drive: what was measured, and what models make of the same commands from the
/// measured pose at its beginning on. Poses relative to that one, at 0, kSample, 2 kSample, ...
struct Piece {
  double begin = 0.0;  ///< [s] of the drive
  std::vector<Pose2> measured;
  std::vector<std::vector<Pose2>> predicted;  ///< by model

  double positionError(size_t model, size_t sample) const;  ///< [m]
  double yawError(size_t model, size_t sample) const;       ///< [rad]
};

/// The drive in pieces of a length [s], without those in which the vehicle hardly moved, the INS
/// was silent for more than 0.3 s, or the log begins less than 3 s before.
/** A model drives through the 3 s before, from rest, so that its tracks and delays are under way;
 * it knows slopes and battery as the log does, and its INS part is between it and what is compared.
 * Throws std::runtime_error if the models take another kind of command than was given. */
std::vector<Piece> replay(const LoggedDrive& drive, const std::vector<ModelDocument>& models,
                          double length);

/// Median over the pieces of the errors of a model at a sample: [m] and [rad].
struct Errors {
  double position = 0.0;
  double yaw = 0.0;
};
Errors medianErrors(const std::vector<Piece>& pieces, size_t model, size_t sample);

/// Draws six pieces, evenly chosen over the drive, as measured and by model, and how the models'
/// median errors grow.
/** Throws std::runtime_error with one clear line if the file cannot be written. */
void drawOverlay(const std::string& path, const std::string& title,
                 const std::vector<Piece>& pieces, const std::vector<std::string>& model_names);

}  // namespace tread::overlay
