// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "modules/learner/core/rules/learning_rule.hpp"
#include "modules/learner/core/rules/surface_bank.hpp"
#include "tools/experiment/ground.hpp"

namespace tread::experiment {

/// What the rule `bank` met on one surface of its tour.
struct TourLeg {
  std::string surface;
  int executions = 0;
  int stored_after = 0;  ///< executions until it was put into the bank; 0 = it was not
};

/// A tour, and what the bank holds after it.
struct Tour {
  std::vector<TourLeg> legs;
  std::vector<learner::RememberedSurface> stored;
  /// By stored surface: the surfaces whose recordings are likelier on it than on any other stored.
  std::vector<std::vector<std::string>> explains;
};

/// Surfaces of a tour: all but `home` and `unseen`, then `home` (if it is not `unseen`).
struct TourPlan {
  size_t home = 0;
  size_t unseen = 0;         ///< no surface's index: none is left out
  int64_t executions = 200;  ///< on each surface
};

/// Drives random patterns of the whole set on each surface, the others in random order.
std::vector<TourLeg> driveTour(learner::LearningRule& rule, const std::vector<Ground>& grounds,
                               const TourPlan& plan, uint64_t seed);
/// One tour of the rule `bank`, which begins with an empty bank and the home surface's set.
Tour tourOfBank(const learner::RuleConfig& config, const std::vector<Ground>& grounds,
                const TourPlan& plan, uint64_t seed);

/// Legs and stored surfaces of tours, with the corrections by name.
std::string textOfTours(const std::vector<Tour>& tours, const PatternSet& set);

}  // namespace tread::experiment
