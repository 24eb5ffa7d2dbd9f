// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "common/vehicle/effects.hpp"

namespace tread {

std::vector<Effect> inertiaEffects();               ///< inertia, centre of rotation, crab
std::vector<Effect> sideEffects();                  ///< drift and slopes
std::vector<Effect> timingEffects();                ///< effects that no drive can distinguish
std::vector<Effect> mountingEffects();              ///< effects that a better drive can distinguish
std::vector<ConfoundedGroup> groupsOfEveryDrive();  ///< groups that no drive can distinguish
std::vector<ConfoundedGroup> groupsOfPoorDrives();  ///< groups that a better drive can distinguish

}  // namespace tread
