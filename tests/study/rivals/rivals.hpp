// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "modules/identification/core/drive.hpp"
#include "modules/identification/core/finding.hpp"

namespace tread::rivals {

/// What a rival method names in a drive.
struct Answer {
  ModelDocument model;                             ///< with what it has estimated
  std::vector<gap::ParameterEstimate> parameters;  ///< of the effects that it names
};

/// Least squares over all parameters at once, as the identification tools of common simulators do.
/** Every effect of the catalogue is free, in its likeliest form, but for changes at a moment, the
 * scale of positions and all but one of twins; the damped fit begins where the given model is. It
 * names what differs from 0 by more than 95 % certainty over all of them (Bonferroni), with errors
 * from the scatter of blocks. */
Answer allParameters(const ModelDocument& model, const std::vector<gap::Drive>& drives);

/// Sequentially thresholded least squares (SINDy: Brunton, Proctor, Kutz 2016) on the residuals,
/// with the directions of the catalogue's effects as library, in the integral form.
/** The threshold, as a share of the residual that a term explains, is the one with the least error
 * on blocks left out, among ten. It names what is left. */
Answer sparseRegression(const ModelDocument& model, const std::vector<gap::Drive>& drives);

}  // namespace tread::rivals
