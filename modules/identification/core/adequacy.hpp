// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "modules/identification/core/finding.hpp"
#include "modules/identification/core/fit.hpp"

// On what residuals still depend: a test, and pictures of it.
namespace tread::gap {

/// A quantity on which residuals may depend, at each observation.
struct Variable {
  std::string name;  ///< "v", "yaw rate", "v x yaw rate", ...
  std::string unit;
  Eigen::VectorXd values;  ///< rows x 1
};

/// All such quantities, from the simulated motion, the roll and pitch of the INS and the time.
std::vector<Variable> variablesOf(const Observations& data, const ModelDocument& model);

/// Tests every channel of the residuals for every variable, with the state's free parameters.
Adequacy testAdequacy(const Fitter& fitter, const FitState& state, double alpha, uint64_t seed);

/// Where the residuals of two models are: curves of every channel over every variable, and maps
/// over speed and yaw rate.
/** The interval of a curve's cell is from the scatter of its blocks' means; cells that exclude 0
 * after correction for the number of cells (Bonferroni, 5 %) are marked. */
ResidualAtlas residualAtlas(const Observations& observations, const ModelDocument& before,
                            const ModelDocument& after);

}  // namespace tread::gap
