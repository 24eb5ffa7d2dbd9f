// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "common/vehicle/effects.hpp"

namespace tread {

std::vector<Effect> commandEffects();  ///< of a command on its way to the motor
std::vector<Effect> powerEffects();    ///< power that fades or differs by side
std::vector<Effect> lagEffects();      ///< lags and play of the drive

}  // namespace tread
