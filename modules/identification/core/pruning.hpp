// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "modules/identification/core/search.hpp"

namespace tread::gap {

/// The state with effects switched off; nothing is refitted.
FitState switchedOff(const Fitter& fitter, const FitState& state,
                     const std::vector<std::string>& effects);

/// The state without an effect, its other parameters refitted, with current Jacobian.
FitState without(const Fitter& fitter, const FitState& state, const std::string& effect);

/// The same in first order and without a simulation; nothing is refitted, the model stays as it
/// was.
FitState withoutLinearly(const Fitter& fitter, const FitState& state, const std::string& effect);

/// Removes effects, weakest first, that the others make superfluous.
/** Each that stays passes the score test alone in the presence of the others (evidence() >= 1),
 * improves blocks left out, and the end error by at least `least_gain` of it (0 = however little);
 * accepted ones stay in any case. Fills evidence and record of the result. */
void pruneEffects(const SearchState& search, const Needed& needed);

}  // namespace tread::gap
