// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "tools/robot/patterns/core/pattern_candidates.hpp"

namespace tread::patterns {

/// A pattern, or one and its mirror image, in the order in which they were chosen.
struct DesignedPattern {
  std::vector<std::string> names;      ///< one or two
  std::vector<CandidatePattern> made;  ///< as many
  bool needed = false;                 ///< without it a class cannot be reached, kept or left
  double before = 0.0;                 ///< [m] dispersion without it,
  double after = 0.0;                  ///< and with it
};

/// A recipe that is made, not typed.
struct DesignedRecipe {
  std::string name;
  double period = 0.05;  ///< [s]
  std::vector<DesignedClass> classes;
  std::vector<DesignedPattern> patterns;

  int count() const;
};

/// Chooses from all that a vehicle could do in one pattern so many that their ends cover it best.
/** Dispersion is the root mean square distance of what can be reached from the nearest end of a
 * pattern with the same entry, the mean over entry classes. An angle counts as the way that it
 * makes in the length of the gap; another exit speed as the way that it makes until it is changed.
 *  1. What a set cannot do without: each class straight on, to it from rest and back, from speed to
 *     speed, and turns on the spot, of a car turns from rest.
 *  2. Then one after the other what lowers the dispersion most for each pattern (greedy; of what a
 *     coverage of this kind allows at best it reaches at least 63 %).
 * Deterministic. Throws std::runtime_error, one line, where the wish cannot be fulfilled. */
DesignedRecipe designRecipe(const VehicleModel& model, const RecipeWish& wish);

}  // namespace tread::patterns
