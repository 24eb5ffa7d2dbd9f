// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <limits>
#include <vector>

#include "modules/planner/core/map/collision_checker.hpp"
#include "modules/planner/core/search/search_problem.hpp"

namespace tread::planner {

/// Upper bounds of the probability that a plan touches an obstacle.
/** At least ten times fewer contacts come than these numbers add up to, because the covariances of
 * the patterns are too wide (tests/bench/RESULTS.md). */
struct PlanRisk {
  double touch = std::numeric_limits<double>::quiet_NaN();      ///< [1] of the whole plan
  double first = std::numeric_limits<double>::quiet_NaN();      ///< [1] of its first pattern
  double per_metre = std::numeric_limits<double>::quiet_NaN();  ///< [1/m] of its way
};

/// What the probability of touching depends on beside map and patterns.
struct RiskQuestion {
  const CollisionChecker& around;
  const PatternTable& patterns;
  const PlanStep& start;  ///< its uncertainty is what the running pattern may still be off by
  const std::vector<PlanStep>& steps;
  double reaction = 0.0;  ///< [s] in which a vehicle that leaves its way is noticed and stands
};

/// Upper bound of the probability that the vehicle touches an obstacle of the map before the plan ends.
/** The way is watched while it is driven, and the vehicle stops before what it would touch; so only
 * errors count that grow within the reaction time. They are normal, with the covariances of the
 * patterns; the variance of one grows evenly over its time. Each side of the footprint may touch
 * what is nearest to it. Errors within a pattern belong together, those of two patterns do not.
 * Unknown ground is no obstacle. */
PlanRisk riskOf(const RiskQuestion& question);

}  // namespace tread::planner
