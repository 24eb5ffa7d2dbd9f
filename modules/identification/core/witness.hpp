// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>

#include "modules/identification/core/finding.hpp"
#include "modules/identification/core/fit.hpp"

namespace tread::gap {

/// How much of an effect the wheel speeds show, which no fit has used; with its 95 % interval over
/// blocks.
/** What the wheels show is in the drive, what they do not show is under it or in the INS. The
 * wheels' radius and the track that counts are unknown, so that their speeds are compared up to one
 * factor for driving and one for turning; of an effect that is such a factor (slip, track width)
 * they say nothing. Encoders that are late themselves show a lag as a little longer than it is.
 * Nothing where no drive has encoders, of effects of the INS and of motion to the side, and where
 * the answer would be vague. `state`: of the whole model, with current prediction. */
std::optional<WheelWitness> wheelWitness(const Fitter& fitter, const FitState& state,
                                         const std::string& effect);

}  // namespace tread::gap
