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
 * shares of all effects are estimated together. The wheels' radius and the track that counts are
 * unknown, so that their speeds are compared up to one factor for driving and one for turning; of
 * an effect that is such a factor (slip, track width) they say nothing. Encoders that are late
 * themselves, by a tenth of a second or two, show a lag as longer than it is. Nothing where no
 * drive has encoders, of effects of the INS and of motion to the side, and where the answer would
 * be vague. `state`: of the whole model, with current prediction. */
std::map<std::string, WheelWitness> wheelWitnesses(const Fitter& fitter, const FitState& state,
                                                   const std::vector<std::string>& effects);

}  // namespace tread::gap
