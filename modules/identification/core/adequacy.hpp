// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>

#include "modules/identification/core/finding.hpp"
#include "modules/identification/core/fit.hpp"

namespace tread::gap {

/// Tests every channel of the residuals for each variable, with the state's free parameters, and
/// for any smooth function of all conditions together.
/** For the strongest remainders it names the effect of the catalogue, on or off, that they resemble
 * most in their channel. They are not attributed to that effect: its size was already free, or a
 * test or a person excluded it. The error probability is `alpha` over all variables, plus half of
 * it for the smooth functions, so that these do not reduce the variables' power; smooth functions
 * are reported for channels without a variable, by their most important condition. If the fitter
 * predicts a rest, both are tested for what exceeds it. */
Adequacy testAdequacy(const Fitter& fitter, const FitState& state, double alpha, uint64_t seed);

/// The residuals of two models: curves of every channel over the standard variables and over the
/// unexplained ones, and maps over speed and yaw rate.
/** The interval of a curve's cell is from the scatter of its blocks' means; cells that exclude 0
 * after correction for the number of cells (Bonferroni, 5 %) are marked. */
ResidualAtlas residualAtlas(const Observations& observations, const ModelDocument& before,
                            const ModelDocument& after,
                            const std::vector<Unexplained>& unexplained = {});

}  // namespace tread::gap
