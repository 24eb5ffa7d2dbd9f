// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/soundness/core/log_validation.hpp"

namespace tread::gap {

/// The largest of the commands that move the vehicle.
double largestCommand(const Drive& drive);
/// Seconds between two times in which commands of at least `least` act, the last one until `end`.
double drivenBetween(VehicleLayout layout, const std::vector<CommandSample>& commands, double end,
                     double from, double to, double least);
/// Number of different commands, to a hundredth of the largest one.
size_t differentCommands(const Drive& drive);

void checkPoses(const Drive& drive, const std::vector<PoseIncrement>& increments,
                Diagnostics& notes);
void describeStandstill(const Drive& drive, Diagnostics& notes);
void describeDriving(const Drive& drive, const std::vector<PoseIncrement>& increments,
                     Diagnostics& notes);

}  // namespace tread::gap
