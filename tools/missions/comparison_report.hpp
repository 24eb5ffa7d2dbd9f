// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "tools/missions/report.hpp"

namespace tread::missions {

/// The same worlds once for each rule, and the executions of the first rule's drives judged by all.
/** Campaigns have the same seeds; the missions of the first one carry shadow rules. Two comparisons
 * come of it. In the same worlds: each rule plans its own way, as it would on the robot. The same
 * executions: every rule predicts what the first one drove, so that luck with the way counts for
 * nothing. With both, the number of executions until a rule is as good as the omniscient one
 * (Settling). */
struct Comparison {
  std::vector<Campaign> campaigns;  ///< one per rule, at least one
};

/// Side by side, a line a rule.
void printComparison(std::ostream& out, const Comparison& comparison);

/// The same with all missions, machine-readable; throws std::runtime_error with one clear line if
/// it cannot be written.
void writeComparison(const std::string& path, const Comparison& comparison);

}  // namespace tread::missions
