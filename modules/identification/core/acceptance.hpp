// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "modules/identification/core/fit.hpp"

namespace tread::gap {

/// Switches an effect of the catalogue on in a state and fits all, whatever tests would say.
/** Of several ways in which it could act (thresholds, moments) the most promising one. Returns why
 * the drive cannot size it, and leaves the state as it was; empty if it can. */
std::string takeIn(const Fitter& fitter, FitState& state, const std::string& effect,
                   const std::vector<char>& mask);

}  // namespace tread::gap
