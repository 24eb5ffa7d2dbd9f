// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "tools/missions/report.hpp"

namespace tread::missions {

/// Every rule drives the same worlds; every rule also predicts the first rule's executions.
/** Batches have the same seeds; the missions of the first one carry shadow rules. Two comparisons
 * come of it. In the same worlds: each rule plans its own way, as it would on the robot. The same
 * executions: every rule predicts what the first one drove, so that luck with the way counts for
 * nothing. With both, the number of executions until a rule is as good as the omniscient one
 * (Settling). */
struct RuleComparison {
  std::vector<Batch> batches;  ///< one per rule, at least one
};

/// Side by side, a line a rule.
void printComparison(std::ostream& out, const RuleComparison& comparison);

/// The same with all missions, machine-readable; throws std::runtime_error with one clear line if
/// it cannot be written.
void writeComparison(const std::string& path, const RuleComparison& comparison);

/// The same missions driven by the learning robot and by one that knows its ground.
struct OmniscientComparison {
  Batch learning;
  Batch omniscient;
};

/// Time to the goal of a mission over that of the omniscient robot.
struct TimeRatio {
  uint64_t seed = 0;
  double learning = 0.0;    ///< [s] from the first motion to the goal
  double omniscient = 0.0;  ///< [s]
  double ratio() const { return learning / omniscient; }
};

/// Of the missions in which both arrive, the smallest ratio first.
std::vector<TimeRatio> timeRatios(const OmniscientComparison& comparison);

/// Smallest ratio that a share of the missions does not exceed (nearest rank); NaN without any.
double quantileOf(const std::vector<TimeRatio>& sorted, double share);

/// How many each solved, ratios of times, and the missions with the largest ones.
void printOmniscient(std::ostream& out, const OmniscientComparison& comparison);

/// Both batches and all ratios; throws std::runtime_error with one line if it cannot be written.
void writeOmniscient(const std::string& path, const OmniscientComparison& comparison);

}  // namespace tread::missions
