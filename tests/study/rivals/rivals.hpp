// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "modules/identification/core/finding.hpp"
#include "modules/identification/core/fit.hpp"

namespace tread::rivals {

/// What a rival method makes of a drive.
struct Answer {
  ModelDocument model;                             ///< with what it has estimated
  std::vector<std::string> estimated;              ///< paths of all that it has estimated
  std::vector<gap::ParameterEstimate> parameters;  ///< of the effects that it names
};

/// Least squares over all parameters at once, as the identification tools of common simulators do.
/** Every effect of the catalogue is free, in its likeliest form, but for changes at a moment, the
 * scale of positions and all but one of twins; the damped fit begins where the given model is. It
 * names what differs from 0 by more than 95 % certainty over all of them (Bonferroni), with errors
 * from the scatter of blocks. On the fitter's rows; `calibrate`: numbers of the nominal model are
 * free, too. */
Answer allParameters(const gap::Fitter& fitter, const ModelDocument& model, bool calibrate);

/// Sequentially thresholded least squares (SINDy: Brunton, Proctor, Kutz 2016) on the residuals,
/// with the directions of the catalogue's effects as library, in the integral form.
/** The threshold, as a share of the residual that a term explains, is the one with the least error
 * on blocks left out, among ten. It names what is left, whose sizes are then fitted in simulation
 * (as the regression gives them, in first order, they predict far worse). Rows and `calibrate` as
 * above. */
Answer sparseRegression(const gap::Fitter& fitter, const ModelDocument& model, bool calibrate);

}  // namespace tread::rivals
