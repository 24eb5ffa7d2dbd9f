// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cmath>
#include <vector>

#include "modules/identification/core/search.hpp"

// Numbers and terms that the model gives, and that this drive says are others now.
namespace tread::gap {

/// How far the free parameters of a result are from what the model says of them by chance.
struct Moves {
  double most = 0.0;           ///< [standard errors] that any of them goes by chance
  Eigen::MatrixXd covariance;  ///< free x free
  /// Given terms that went further together than chance, though each alone may.
  std::vector<char> together;

  /// The furthest that one goes by chance, in its unit.
  double byChance(size_t index) const {
    const auto at = static_cast<Eigen::Index>(index);
    return most * std::sqrt(covariance(at, at));
  }
};

/// Where `before` is the model that the search began with.
Moves movesOf(const Fitter& fitter, const ModelDocument& before, const FoundTerms& result);

/// Whether a free parameter is of the rest or of an unnamed term: none that a person knows by name,
/// and none that is said to have moved.
bool isNameless(const FitState& state, size_t index);

/// Whether a term of the model has changed, or a number of which it says how sure it is.
bool hasMoved(const ParameterEstimate& estimate, double most_by_chance, bool calibrate);

/// Estimates what has moved anew, without what the model says of it, which is of the vehicle as it
/// was and would hold the new size back.
/** As few as explain the drive: a term that is as well what the model says stays that, and one
 * effect that explains as much takes the place of two changes, of which one may be an effect that
 * was found. Nothing where all is calibrated. */
void reestimateMoved(const SearchState& search, const ModelDocument& before);

}  // namespace tread::gap
