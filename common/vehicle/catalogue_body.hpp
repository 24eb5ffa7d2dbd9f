// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "common/vehicle/effects.hpp"

namespace tread {

std::vector<Effect> inertiaEffects();               ///< inertia, centre of rotation, crab
std::vector<Effect> sideEffects();                  ///< drift and slopes
std::vector<Effect> timingEffects();                ///< of the INS: latencies and scale
std::vector<Effect> mountingEffects();              ///< of the INS: lever arm, alignment, bias
std::vector<ConfoundedGroup> groupsOfEveryDrive();  ///< that no drive tells apart
std::vector<ConfoundedGroup> groupsOfPoorDrives();  ///< that a better drive tells apart

}  // namespace tread
