// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "modules/identification/core/fit.hpp"
#include "modules/identification/core/search.hpp"
#include "modules/identification/core/variables.hpp"

// Deviations that a model left unexplained when it was made are no news when they appear again: the
// rest of a model document is predicted with the model, and has a prior like any other term.
namespace tread::gap {

/// Variation of a rest from one drive to another, as a share of its size: ground and driving
/// differ.
inline constexpr double kRestVaries = 0.25;

/// The condition of a rest that is a smooth function of all conditions together, see smoothRests().
/** Its size is the root mean square of the function [rad/s or m/s]. It is the whole rest of its
 * channel: bounds what the other terms leave, and what varies, in another drive. */
inline constexpr const char* kAllConditions = "all together";

/// One variable in the rows of one channel, 0 in the others (rows x 1).
Eigen::VectorXd inChannel(const Observations& data, const Variable& variable, ObservedRate channel);

/// Each variable only in the rows of one channel, channel by channel (rows x channels variables).
Eigen::MatrixXd perChannel(const Observations& data, const std::vector<Variable>& variables);

/// The conditions of a model's rest at each row, for a Fitter (rows x terms).
/** Throws std::invalid_argument with one line for an unknown channel or condition. */
Eigen::MatrixXd restConditions(const Observations& data, const ModelDocument& model);

/// The sizes of the rest that a fitter predicts: free, with priors from their deviations and
/// kRestVaries.
std::vector<FreeParameter> restParameters(const Fitter& fitter, const ModelDocument& model);

/// Variance of the pull on a direction, per square of the direction in a row, due to the variation
/// of a known rest from one drive to another (rows x 1) [1 / square of the row's unit].
/** A smooth function of root mean square s pulls on a smooth direction as far as they are alike: by
 * s^2 / n of the maximum, if conditions distinguish n functions. */
Eigen::VectorXd restVariation(const Fitter& fitter, const FitState& state);

/// The rest of a state: a term for each significant condition, strongest first.
/** The terms that the state already has come first, with their fitted sizes. Sizes are fitted
 * together, with the numbers of the model fixed at the document's values, because both predict
 * together. If anything remains, it also estimates how much of each channel is smooth in all
 * conditions. */
std::vector<RestTerm> restOf(const Fitter& fitter, const FitState& state, uint64_t seed);

}  // namespace tread::gap
