// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <iosfwd>
#include <string>
#include <vector>

#include "tools/missions/report.hpp"

namespace tread::missions {

/// The same missions driven by the learning robot and by one that knows its ground.
struct OmniscientComparison {
  Campaign learning;
  Campaign omniscient;
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

/// Both campaigns and all ratios; throws std::runtime_error with one line if it cannot be written.
void writeOmniscient(const std::string& path, const OmniscientComparison& comparison);

}  // namespace tread::missions
