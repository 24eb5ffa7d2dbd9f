// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "modules/identification/core/discovery.hpp"
#include "modules/identification/core/fit.hpp"

// What a model did not explain when it was made is no news when it is there again: the rest of a
// model document is predicted with the model, and held by what is known of it like any other term.
namespace tread::gap {

/// By this share of its size a rest may differ from one drive to another: ground and driving do.
inline constexpr double kRestVaries = 0.25;

/// The condition of a rest that is a smooth function of all conditions together, see smoothRests().
/** Its size is the root mean square of the function [rad/s or m/s]. It is the whole rest of its
 * channel: how large what the other terms leave, and what varies, may be in another drive. */
inline constexpr const char* kAllConditions = "all together";

/// One variable in the rows of one channel, 0 in others (rows x 1).
Eigen::VectorXd inChannel(const Observations& data, const Variable& variable, ObservedRate channel);

/// Each variable in the rows of one channel only, channel by channel (rows x channels variables).
Eigen::MatrixXd perChannel(const Observations& data, const std::vector<Variable>& variables);

/// The conditions of a model's rest at each row, for a Fitter (rows x terms).
/** Throws std::invalid_argument with one line for a channel or condition that nothing tests. */
Eigen::MatrixXd restConditions(const Observations& data, const ModelDocument& model);

/// The sizes of the rest that a fitter predicts: free, and held by their deviations and by
/// kRestVaries.
std::vector<FreeParameter> restParameters(const Fitter& fitter, const ModelDocument& model);

/// Variance of the pull on a direction, per square of the direction in a row, by which a rest that
/// is known varies from one drive to another (rows x 1) [1 / square of the row's unit].
/** A smooth function of root mean square s pulls on a direction that is smooth, too, as far as they
 * are alike: by s^2 / n of what would be most, where conditions tell n functions apart. */
Eigen::VectorXd restVariation(const Fitter& fitter, const FitState& state);

/// What a state leaves unexplained: a term for each condition beyond chance, strongest first.
/** The terms that the state has come first, with their sizes as fitted. Sizes are fitted together,
 * the numbers of the model held at what the document says: both together predict. Then, where
 * anything is left over at all, how much of each channel is smooth in all conditions. */
std::vector<RestTerm> restOf(const Fitter& fitter, const FitState& state, uint64_t seed);

}  // namespace tread::gap
