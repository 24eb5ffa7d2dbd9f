// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <string>
#include <vector>

#include "modules/identification/core/finding.hpp"
#include "modules/identification/core/fit.hpp"

namespace tread::gap {

/// By how much the motor currents rise with each effect, beyond their ordinary dependence on the
/// tracks' speed, its change and dry friction; with 95 % intervals over blocks.
/** What takes speed by a load draws current; what the drive does not give draws none, and neither
 * do tracks that slip. Only torques count, so `currents` must be those of the motors, not of the
 * battery. Nothing where no drive has currents, or ones that do not follow the motion (stuck, cut
 * off, of another machine), of lags and what else acts on changes alone, of the INS, of motion to
 * the side, and of an effect that looks like the ordinary dependence (a factor on all motion, a dry
 * friction). */
std::map<std::string, CurrentWitness> currentWitnesses(const Fitter& fitter, const FitState& state,
                                                       const std::vector<std::string>& effects);

}  // namespace tread::gap
