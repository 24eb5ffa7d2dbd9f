// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "modules/identification/core/search.hpp"
#include "modules/identification/core/variables.hpp"

namespace tread::gap {

/// Whether the residuals of some channels are a smooth function of all conditions together.
struct SmoothRest {
  std::vector<ObservedRate> channels;  ///< tested together: both channels of turning, or one
  double p_value = 1.0;                ///< over all channels (Bonferroni)
  double score = 0.0;          ///< above its mean, in standard deviations under the null hypothesis
  std::string variable{};      ///< the most influential one; empty if chance explains it
  Eigen::VectorXd function{};  ///< as fitted, 0 in other channels (rows x 1); empty likewise
  double size = 0.0;           ///< its root mean square, corrected for chance [rad/s or m/s]
  double deviation = 0.0;      ///< standard deviation of the size by chance
};

/// Tests channels for a smooth function of all inputs, without a prescribed form.
/** Random Fourier features (Rahimi and Recht 2007), each of one to three inputs in units of their
 * deviation, a third of them times the speed and a third times the yaw rate: cos(w x + phase).
 * Orthogonalized to the free parameters, with a ridge prior on their sizes, they give one
 * quadratic score: the mutual pulls of blocks, as far as they agree under similar conditions. Its
 * null distribution comes from random signs of the blocks, as in ScoreTest. If it is significant
 * (`alpha`), the variable is the most informative input, alone and in addition to all others. For
 * a channel with a `known` rest (see kAllConditions) only the excess counts. `inputs`: speed and
 * yaw rate first. */
std::vector<SmoothRest> smoothRests(const Fitter& fitter, const FitState& state,
                                    const std::vector<Variable>& inputs,
                                    const std::vector<RestTerm>& known, double alpha,
                                    uint64_t seed);

}  // namespace tread::gap
