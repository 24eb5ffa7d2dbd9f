// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "modules/identification/core/finding.hpp"
#include "modules/identification/core/fit.hpp"

namespace tread::gap {

/// A quantity on which residuals may depend, in every row.
struct Variable {
  std::string name;  ///< "v", "yaw rate", "v x yaw rate", ...
  std::string unit;
  Eigen::VectorXd values;  ///< rows x 1
};

/// What goes on in each row, from the simulated motion, the INS's roll and pitch and the time.
std::vector<Variable> variablesOf(const Rows& rows, const ModelDocument& model);

/// What is left that depends on something.
struct Adequacy {
  double p_value = 1.0;                  ///< of the largest dependence over all
  std::vector<Unexplained> unexplained;  ///< those below alpha, strongest of each channel first
};

/// Tests every channel of the residuals for every variable, with the state's free parameters.
Adequacy testAdequacy(const Fitter& fitter, const FitState& state, const std::vector<char>& mask,
                      double alpha, uint64_t seed);

}  // namespace tread::gap
