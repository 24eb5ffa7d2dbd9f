// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "common/vehicle/effects.hpp"

namespace tread {

std::vector<Effect> steeringEffects();  ///< of a car's steering
std::vector<Effect> wheelEffects();     ///< of the wheels of a holonomic base
std::vector<Effect> sidewaysEffects();  ///< of the lateral motion of a holonomic base

}  // namespace tread
