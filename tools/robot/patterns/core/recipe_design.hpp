// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "tools/robot/patterns/core/pattern_candidates.hpp"

namespace tread::patterns {

/// A chosen pattern, with its mirror image if there is one; in the order of choice.
struct DesignedPattern {
  std::vector<std::string> names;      ///< one or two
  std::vector<CandidatePattern> made;  ///< as many as names
  bool needed = false;  ///< mandatory: without it a class cannot be reached, kept or left
  double before = 0.0;  ///< [m] dispersion without it,
  double after = 0.0;   ///< and with it
};

/// A designed recipe.
struct DesignedRecipe {
  std::string name;
  double period = 0.05;  ///< [s]
  std::vector<DesignedClass> classes;
  std::vector<DesignedPattern> patterns;

  int count() const;
};

/// Selects the candidates whose ends cover the reachable end points best.
/** Dispersion is the root mean square distance from a reachable end point to the nearest end of a
 * pattern with the same entry class, averaged over entry classes. An angle counts as the distance
 * that it causes over the length of the gap; a different exit speed as the distance driven until
 * it is corrected.
 * 1. Mandatory patterns: each class straight on, to it from rest and back, between neighbouring
 *    speeds, and turns on the spot, for a car turns from rest.
 * 2. Then repeatedly the pair that lowers the dispersion most per pattern (greedy; at least 63 %
 *   of
 *    the best possible gain for a coverage of this kind).
 * Deterministic. Throws std::runtime_error, one line, if the wish cannot be fulfilled. */
DesignedRecipe designRecipe(const VehicleModel& model, const RecipeWish& wish);

}  // namespace tread::patterns
