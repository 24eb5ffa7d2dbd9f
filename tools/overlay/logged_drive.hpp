// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/geometry/se2.hpp"
#include "common/pattern/pattern.hpp"

namespace tread::overlay {

/// A command that was on the motors from a moment until the next one.
struct GivenCommand {
  double time = 0.0;  ///< [s] since the first MOTOR message
  TrackCommand command;
  double battery_drop = 0.0;  ///< [1] relative fall of the voltage since then; 0 = not measured
};

/// What the INS said at a moment.
struct MeasuredPose {
  double time = 0.0;   ///< [s] since the first MOTOR message
  Pose2 T_map_body;    ///< yaw unwrapped
  double roll = 0.0;   ///< [rad] left side up positive
  double pitch = 0.0;  ///< [rad] nose down positive
};

/// What was commanded and what was measured, in the order of time.
struct LoggedDrive {
  CommandKind kind = CommandKind::kPower;
  std::vector<GivenCommand> commands;
  std::vector<MeasuredPose> track;
};

/// Reads MOTOR and INS of LCM logs that are parts of one recording, in order.
/** Throws std::runtime_error with one clear line if a log cannot be read, or if one of the two
 * channels is not in them, or if nothing was driven. */
LoggedDrive readLoggedDrive(const std::vector<std::string>& logs);

}  // namespace tread::overlay
