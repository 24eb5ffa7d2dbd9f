// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "modules/identification/core/search.hpp"

namespace tread::gap {

/// The state with effects switched off; nothing is refitted.
FitState switchedOff(const Fitter& fitter, const FitState& state,
                     const std::vector<std::string>& effects);

/// The state without an effect, with the other parameters refitted and a current Jacobian.
FitState without(const Fitter& fitter, const FitState& state, const std::string& effect);

/// The same in first order, without simulation or refit; the model is not changed.
FitState withoutLinearly(const Fitter& fitter, const FitState& state, const std::string& effect);

/// Removes effects that the others make superfluous, weakest first.
/** Each remaining one passes the score test in the presence of the others (evidence() >= 1),
 * improves held-out blocks, and improves the end error by at least the share `least_gain` (0 = any
 * amount); accepted ones always stay. Fills evidence and record of the result. */
void pruneEffects(const SearchState& search, const Needed& needed);

}  // namespace tread::gap
