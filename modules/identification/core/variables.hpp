// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/vehicle/model_document.hpp"
#include "modules/identification/core/observations.hpp"

namespace tread::gap {

/// A quantity on which residuals may depend, at each observation.
struct Variable {
  std::string name;  ///< "v", "yaw rate", "v x yaw rate", ...
  std::string unit;
  Eigen::VectorXd values;  ///< rows x 1
};

/// All such quantities, from the simulated motion, the INS's roll and pitch, and the time.
std::vector<Variable> variablesOf(const Observations& data, const ModelDocument& model);

/// Simple conditions of the motion, the commands and the recent past on which the residuals may
/// depend; speed and yaw rate first.
std::vector<Variable> inputsOf(const Observations& data, const ModelDocument& model);

}  // namespace tread::gap
