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

}  // namespace tread::gap
