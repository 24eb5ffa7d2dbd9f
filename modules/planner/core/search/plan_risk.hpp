// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <limits>
#include <vector>

#include "modules/planner/core/map/collision_checker.hpp"
#include "modules/planner/core/search/search_problem.hpp"

namespace tread::planner {

/// Upper bounds of the probability that a plan touches an obstacle.
/** Contacts are at least ten times rarer than the sum of these numbers, because the covariances of
 * the patterns are too wide (tests/bench/RESULTS.md). */
struct PlanRisk {
  double touch = std::numeric_limits<double>::quiet_NaN();      ///< [1] of the whole plan
  double first = std::numeric_limits<double>::quiet_NaN();      ///< [1] of its first pattern
  double per_metre = std::numeric_limits<double>::quiet_NaN();  ///< [1/m] of its path
};

/// Inputs of the risk beside map and patterns.
struct RiskQuestion {
  const CollisionChecker& around;
  const PatternTable& patterns;
  const PlanStep& start;  ///< its uncertainty is the remaining error of the running pattern
  const std::vector<PlanStep>& steps;
  double reaction = 0.0;  ///< [s] until a vehicle that leaves its path is detected and stopped
};

/// Upper bound of the probability that the vehicle touches an obstacle of the map before the plan
/// ends.
/** The path is monitored during driving, and the vehicle stops before an obstacle; so only errors
 * that grow within the reaction time count. They are normal, with the covariances of the patterns;
 * the variance of each grows evenly over its duration. Each side of the footprint may touch its
 * nearest obstacle. Errors within a pattern are fully correlated, those of two patterns
 * independent. Unknown ground is no obstacle. */
PlanRisk riskOf(const RiskQuestion& question);

}  // namespace tread::planner
