// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "modules/identification/core/candidates.hpp"

namespace tread::gap {

/// Directions of candidates that were simulated once and serve again.
/** A direction hardly changes when another effect joins the model, and not at all with the rows
 * that a fit looks at: so those of the first test serve the halves of a nested evaluation, too. */
class DirectionBook {
 public:
  /// What the limits of candidates are taken from, measured with the first state.
  const Excitation& excitation(const Fitter& fitter, const FitState& state);

  /// Directions of candidates, rows x candidates; those that are not known are simulated.
  Eigen::MatrixXd directions(const Fitter& fitter, const FitState& state,
                             const std::vector<Candidate>& candidates);

  /// Simulates some candidates again at a state.
  void renew(const Fitter& fitter, const FitState& state, const std::vector<Candidate>& candidates);

 private:
  struct Page {
    Candidate candidate;
    Eigen::VectorXd direction;
  };
  Page* pageOf(const Candidate& candidate);

  bool measured_ = false;
  Excitation excitation_;
  std::vector<Page> pages_;
};

}  // namespace tread::gap
