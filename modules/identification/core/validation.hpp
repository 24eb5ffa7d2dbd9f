// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include <Eigen/Core>

#include "modules/identification/core/fit.hpp"

namespace tread::gap {

/// Loss of every block when the parameters come from the other blocks (blocks x 1) [nats].
/** Folds of whole blocks; a fold's parameters are those of a linearised refit from the state's
 * optimum without it, so that no simulation is needed. The state's Jacobian must be current. */
Eigen::VectorXd heldOutLoss(const Observations& data, const FitState& state,
                            const std::vector<char>& mask);

/// Lets the free parameters of a state follow its residuals in first order: the prediction changes,
/// the model does not.
void followLinearly(const Fitter& fitter, FitState& state, const std::vector<char>& mask);

/// A difference over blocks and its standard error.
struct Gain {
  double value = 0.0;  ///< [nats]
  double error = 0.0;
};

/// What the second has less than the first.
Gain gainOf(const Eigen::VectorXd& first, const Eigen::VectorXd& second,
            const std::vector<char>& block_counts);

/// Which blocks have rows that count.
std::vector<char> blocksThatCount(const Observations& data, const std::vector<char>& mask);

/// Covariance of the free parameters from the scatter of the blocks' pulls (free x free).
/** Sandwich over blocks with its small-sample factor; a direction of no information is infinite
 * (a diagonal of 1e12 times the square of its step). */
Eigen::MatrixXd parameterCovariance(const Observations& data, const FitState& state,
                                    const std::vector<char>& mask);

}  // namespace tread::gap
