// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <string>
#include <vector>

#include "common/recordings/imported_log.hpp"

namespace tread::import {

/// What was found in a recording of another robot.
struct ForeignDrive {
  recordings::RecordedDrive drive;
  std::string poses;                       ///< whose poses were taken, in words
  std::map<std::string, size_t> left_out;  ///< what was not taken, and why
};

/// No pose of these robots is farther out [m].
inline constexpr double kFarthest = 100'000.0;
/// Recordings last no longer [s].
inline constexpr double kLongest = 7.0 * 86'400.0;
/// A command is as good as gone if none came for so long [s].
inline constexpr double kCommandAge = 0.5;

/// Commands as they came become a sample every 50 ms: the newest command, none once it is older
/// than `age` [s].
void holdCommands(std::vector<recordings::DriveSample> commands, double age,
                  recordings::RecordedDrive& drive);

/// Runs of one command other than zero; equal commands have equal numbers.
void findRuns(recordings::RecordedDrive& drive);

}  // namespace tread::import
