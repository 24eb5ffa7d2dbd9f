// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <string>
#include <vector>

#include "modules/identification/core/finding.hpp"
#include "modules/identification/core/fit.hpp"

namespace tread::gap {

/// Share of each effect that the wheel speeds show (they are never fitted); with 95 % intervals
/// over blocks.
/** Effects that the wheels show are in the drive, the others below it or in the INS. The shares of
 * all effects are estimated together; if two resemble each other but have different answers,
 * neither gets one. The wheels' radius and effective track are unknown, so their speeds are
 * compared up to one factor for driving and one for turning; effects that equal such a factor
 * (slip, track width) get no answer. Encoders with a lag of their own, by a tenth of a second or
 * two, make a lag look longer. No entry without encoders, for effects of the INS and on lateral
 * motion, and for vague answers. `state`: of the whole model, with a current prediction. */
std::map<std::string, WheelWitness> wheelWitnesses(const Fitter& fitter, const FitState& state,
                                                   const std::vector<std::string>& effects);

/// Rise of the motor currents with each effect, beyond their usual dependence on the tracks' speed,
/// its change and dry friction; with 95 % intervals over blocks.
/** A load that reduces the speed draws current; a weak drive or slipping tracks do not. Only
 * torques count, so `currents` must be those of the motors, not of the battery. No entry without
 * currents, for currents that do not follow the motion (stuck, cut off, of another machine), for
 * lags and other effects on changes only, for the INS, for lateral motion, and for an effect that
 * resembles the usual dependence (a factor on all motion, a dry friction). */
std::map<std::string, CurrentWitness> currentWitnesses(const Fitter& fitter, const FitState& state,
                                                       const std::vector<std::string>& effects);

/// Share of each intermittent effect that the battery voltage also shows; with 95 % intervals over
/// blocks.
/** A motor's speed is proportional to its voltage. No entry without a measured voltage, and for
 * effects that are not one factor on the motion that changes between blocks. */
std::map<std::string, VoltageWitness> voltageWitnesses(const Fitter& fitter, const FitState& state,
                                                       const std::vector<std::string>& effects);

}  // namespace tread::gap
