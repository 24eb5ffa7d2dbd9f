// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cmath>
#include <vector>

#include "modules/identification/core/search.hpp"
#include "modules/identification/core/search_steps.hpp"

// Numbers and terms given by the model whose values have changed in this drive.
namespace tread::gap {

/// Chance deviations of a result's free parameters from the model's values.
struct Moves {
  double most = 0.0;           ///< [standard errors] largest deviation by chance
  Eigen::MatrixXd covariance;  ///< free x free
  /// Given terms that moved together more than by chance, though each alone may not.
  std::vector<char> together;

  /// The largest deviation by chance, in its unit.
  double byChance(size_t index) const {
    const auto at = static_cast<Eigen::Index>(index);
    return most * std::sqrt(covariance(at, at));
  }
};

/// `before` is the model at the start of the search.
Moves movesOf(const Fitter& fitter, const ModelDocument& before, const FoundTerms& result);

/// Whether a free parameter belongs to the rest or to an unnamed term: it has no name known to
/// users, and is not reported as moved.
bool isNameless(const FitState& state, size_t index);

/// Whether a term of the model, or a number with a known certainty, has changed.
bool hasMoved(const ParameterEstimate& estimate, double most_by_chance, bool calibrate);

/// Given terms with a known certainty that a search has freed of their priors.
std::vector<MovedTerm> freedTerms(const SearchState& search);

/// Re-estimates moved terms without the model's prior, which describes the earlier vehicle and
/// would hold back the new size.
/** Frees as few as explain the drive: a term for which the model's value is as good keeps it, and
 * one effect that explains as much replaces two changes, one of which may be a found effect. Does
 * nothing when everything is calibrated. */
void reestimateMoved(const SearchState& search, const ModelDocument& before);

}  // namespace tread::gap
