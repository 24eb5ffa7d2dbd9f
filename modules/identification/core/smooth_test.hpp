// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "modules/identification/core/discovery.hpp"

namespace tread::gap {

/// Whether the residuals of some channels are a smooth function of all conditions together.
struct SmoothRest {
  std::vector<ObservedRate> channels;  ///< tested together: both that tell of turning, or one
  double p_value = 1.0;                ///< over all channels (Bonferroni)
  double score = 0.0;                  ///< standard deviations of chance above its mean
  std::string variable{};              ///< on which it depends most; empty where chance explains it
  Eigen::VectorXd function{};  ///< as fitted, 0 in other channels (rows x 1); empty likewise
  double size = 0.0;           ///< its root mean square, without chance [rad/s or m/s]
  double deviation = 0.0;      ///< by which chance makes the size larger
};

/// Tests channels for a smooth function of all inputs, of which no form is known beforehand.
/** Random Fourier features (Rahimi and Recht 2007), each of one to three inputs in units of their
 * deviation, a third of them times the speed and a third times the yaw rate: cos(w x + phase).
 * Freed of what the free parameters explain, with a ridge prior on their sizes, they give one
 * quadratic score: the pulls of blocks on one another, as far as they agree where conditions are
 * alike. Its distribution under "nothing is there" comes from random signs of the blocks, as in
 * ScoreTest. Where it is beyond chance (`alpha`) the variable is the input that says most, by
 * itself and beyond all others. Of a channel of whose rest so much is `known` (see kAllConditions)
 * only what exceeds it counts. `inputs`: speed and yaw rate first. */
std::vector<SmoothRest> smoothRests(const Fitter& fitter, const FitState& state,
                                    const std::vector<Variable>& inputs,
                                    const std::vector<RestTerm>& known, double alpha,
                                    uint64_t seed);

}  // namespace tread::gap
