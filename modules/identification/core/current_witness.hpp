// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <string>
#include <vector>

#include "modules/identification/core/finding.hpp"
#include "modules/identification/core/fit.hpp"

namespace tread::gap {

/// Rise of the motor currents with each effect, beyond their usual dependence on the tracks' speed,
/// its change and dry friction; with 95 % intervals over blocks.
/** A load that reduces the speed draws current; a weak drive or slipping tracks do not. Only
 * torques count, so `currents` must be those of the motors, not of the battery. No entry without
 * currents, for currents that do not follow the motion (stuck, cut off, of another machine), for
 * lags and other effects on changes only, for the INS, for lateral motion, and for an effect that
 * resembles the usual dependence (a factor on all motion, a dry friction). */
std::map<std::string, CurrentWitness> currentWitnesses(const Fitter& fitter, const FitState& state,
                                                       const std::vector<std::string>& effects);

}  // namespace tread::gap
