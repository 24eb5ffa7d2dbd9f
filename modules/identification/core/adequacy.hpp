// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>

#include "modules/identification/core/finding.hpp"
#include "modules/identification/core/fit.hpp"

namespace tread::gap {

/// Tests every channel of the residuals for every variable, with the state's free parameters, and
/// for any smooth function of all conditions together.
/** Of the strongest rests it says which effect of the catalogue, on or off, they resemble most in
 * their channel. It is not taken for that effect: its size was free to explain it, or no test, or a
 * person, took it in. The chance of an error is `alpha` over all variables and half of it more for
 * the smooth functions, so that these cost the variables no power; they are told where no variable
 * of their channel is, by the condition that matters most. Where the fitter predicts a rest, both
 * are tested for what is beyond it. */
Adequacy testAdequacy(const Fitter& fitter, const FitState& state, double alpha, uint64_t seed);

}  // namespace tread::gap
