// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "modules/identification/core/finding.hpp"
#include "modules/identification/core/fit.hpp"

namespace tread::rivals {

/// Answer of a rival method.
struct Answer {
  ModelDocument model;                             ///< with its estimates
  std::vector<std::string> estimated;              ///< paths of all estimates
  std::vector<gap::ParameterEstimate> parameters;  ///< of the named effects
};

/// Least squares over all parameters at once, as in the identification tools of common simulators.
/** Every effect of the catalogue is free, in its likeliest form, except for change points, the
 * scale of positions and all but one of indistinguishable effects; the damped fit starts at the
 * given model. It names effects that differ from 0 at 95 % over all of them (Bonferroni), with
 * errors from the scatter of blocks. On the fitter's rows; `calibrate`: numbers of the nominal
 * model are free, too. */
Answer allParameters(const gap::Fitter& fitter, const ModelDocument& model, bool calibrate);

/// Sequentially thresholded least squares (SINDy: Brunton, Proctor, Kutz 2016) on the residualsin
/// integral form, with the directions of the catalogue's effects as library.
/** The threshold, as a share of the residual that a term explains, has the least error on left-out
 * blocks, among ten. It names the remaining effects; their sizes are then fitted in simulation
 * (the first-order sizes of the regression predict far worse). Rows and `calibrate` as above. */
Answer sparseRegression(const gap::Fitter& fitter, const ModelDocument& model, bool calibrate);

}  // namespace tread::rivals
