// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <iosfwd>
#include <map>
#include <string>
#include <vector>

#include "tools/missions/mission.hpp"

namespace tread::missions {

/// How steadily missions were driven.
struct Steadiness {
  double driven = 0.0;  ///< [s] in motion
  int flips = 0;
  int stops = 0;
  int most_stops = 0;      ///< in one mission
  uint64_t most_seed = 0;  ///< and in which
  double stood = 0.0;      ///< [s] in all stops
  /// How often each reason was given; numbers in it are written as #. Empty = none was published.
  std::map<std::string, int> reasons;

  double flipsPerMinute() const { return driven > 0.0 ? 60.0 * flips / driven : 0.0; }
};

Steadiness steadinessOf(const std::vector<MissionResult>& results);

/// Flips per minute driven, stops per mission, and the reasons, the most frequent first.
void printSteadiness(std::ostream& out, const std::vector<MissionResult>& results);

/// A reason with N in the place of each number, so that equal ones can be counted.
std::string withoutNumbers(const std::string& reason);

}  // namespace tread::missions
