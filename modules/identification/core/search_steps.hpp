// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "modules/identification/core/search.hpp"

namespace tread::gap {

/// Switches an effect of the catalogue on in a state and fits all, whatever tests would say.
/** Of several ways in which it could act (thresholds, change points) the most promising one.
 * Returns why the drive cannot size it, and leaves the state as it was; empty if it can. */
std::string takeIn(const Fitter& fitter, FitState& state, const std::string& effect,
                   const std::vector<char>& mask);

/// The state with effects switched off; nothing is refitted.
FitState switchedOff(const Fitter& fitter, const FitState& state,
                     const std::vector<std::string>& effects);

/// The state without an effect, its other parameters refitted, with current Jacobian.
FitState without(const Fitter& fitter, const FitState& state, const std::string& effect,
                 const std::vector<char>& mask);

/// The same in first order and without a simulation; nothing is refitted, the model stays as it
/// was.
FitState withoutLinearly(const Fitter& fitter, const FitState& state, const std::string& effect);

/// Removes effects, weakest first, that the others make superfluous.
/** Each that stays passes the score test alone in the presence of the others (evidence() >= 1),
 * improves blocks left out, and the end error by at least `least_gain` of it (0 = however little);
 * accepted ones stay in any case. Fills evidence and record of the result. */
void pruneEffects(const Fitter& fitter, const std::vector<char>& mask,
                  const SearchSettings& settings, const Needed& needed, SearchResult& result,
                  const Progress& say);

/// Puts one effect in the place of two where it explains as much.
/** Search goes step by step and may reach what one effect does by two others: a scale of positions
 * is slip and track width together. Only effects whose signature the found ones can imitate are
 * tried; the pair goes if it is not better on blocks left out by more than a standard error. */
void replacePairs(const Fitter& fitter, const std::vector<char>& mask,
                  const SearchSettings& settings, SearchResult& result, const Progress& say);

}  // namespace tread::gap
