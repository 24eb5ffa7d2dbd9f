// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "tools/lab/missions/report.hpp"

namespace tread::missions {

/// All rules drive the same worlds, and each rule predicts the first rule's executions.
/** Batches have the same seeds; the missions of the first one carry shadow rules. This gives two
 * comparisons. Same worlds: each rule plans its own path, as on the robot. Same executions: every
 * rule predicts the first rule's drive, which removes the influence of the path. Both give the
 * number of executions until a rule is as good as the oracle (Settling). */
struct RuleComparison {
  std::vector<MissionBatch> batches;  ///< one per rule, at least one
};

/// A table with one line per rule.
void printComparison(std::ostream& out, const RuleComparison& comparison);

/// The same with all missions as JSON; throws std::runtime_error with one clear line if it cannot
/// be written.
void writeComparison(const std::string& path, const RuleComparison& comparison);

/// The same missions with the learning robot and with the omniscient one.
struct OmniscientComparison {
  MissionBatch learning;
  MissionBatch omniscient;
};

/// Time to the goal relative to that of the omniscient robot.
struct TimeRatio {
  uint64_t seed = 0;
  double learning = 0.0;    ///< [s] from the first motion to the goal
  double omniscient = 0.0;  ///< [s]
  double ratio() const { return learning / omniscient; }
};

/// For missions in which both arrive, in ascending order.
std::vector<TimeRatio> timeRatios(const OmniscientComparison& comparison);

/// Quantile of sorted ratios (nearest rank); NaN if empty.
double quantileOf(const std::vector<TimeRatio>& sorted, double share);

/// Numbers of solved missions, ratios of times, and the missions with the largest ratios.
void printOmniscient(std::ostream& out, const OmniscientComparison& comparison);

/// Both batches and all ratios; throws std::runtime_error with one line if it cannot be written.
void writeOmniscient(const std::string& path, const OmniscientComparison& comparison);

}  // namespace tread::missions
