// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <string>
#include <vector>

#include "modules/identification/core/finding.hpp"
#include "modules/identification/core/fit.hpp"

namespace tread::gap {

/// How much of each effect the wheel speeds show, which no fit has used; with 95 % intervals over
/// blocks.
/** What the wheels show is in the drive, what they do not show is under it or in the INS. The
 * shares of all effects are estimated together; where two resemble each other and have other
 * answers, wheels say nothing of either. The wheels' radius and the track that counts are unknown,
 * so that their speeds are compared up to one factor for driving and one for turning; of an effect
 * that is such a factor (slip, track width) they say nothing. Encoders that are late themselves, by
 * a tenth of a second or two, show a lag as longer than it is. Nothing where no drive has encoders,
 * of effects of the INS and of motion to the side, and where the answer would be vague. `state`: of
 * the whole model, with current prediction. */
std::map<std::string, WheelWitness> wheelWitnesses(const Fitter& fitter, const FitState& state,
                                                   const std::vector<std::string>& effects);

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

/// How much of each effect that comes and goes with time the battery voltage falls by, too; with
/// 95 % intervals over blocks.
/** A motor is slower in proportion to its voltage. Nothing where no voltage is measured, and of
 * effects that are not one factor on the motion that changes from block to block. */
std::map<std::string, VoltageWitness> voltageWitnesses(const Fitter& fitter, const FitState& state,
                                                       const std::vector<std::string>& effects);

}  // namespace tread::gap
