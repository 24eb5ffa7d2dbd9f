// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "common/vehicle/effects.hpp"

namespace tread {

std::vector<Effect> slipEffects();           ///< slip and changes of the ground
std::vector<Effect> turningEffects();        ///< resistance to turning
std::vector<Effect> turningChangeEffects();  ///< turning with speed, direction and payload
std::vector<Effect> gripEffects();           ///< limits and offsets of the yaw rate
std::vector<Effect> speedLossEffects();      ///< losses of forward speed

}  // namespace tread
