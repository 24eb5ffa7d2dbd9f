// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

namespace tread::testing {

/// A mission in which one thing goes wrong, and what a debrief may call it.
struct FaultyMission {
  uint64_t seed = 0;
  std::string fault;             ///< in words
  double from = 0.0;             ///< [s] since the log began
  std::set<std::string> causes;  ///< each of these names it rightly
};

/// Kinds of faults that are drawn.
size_t faultKinds();

/// Drives the mission of a seed and records it; kind = seed % faultKinds(), all else is drawn.
FaultyMission driveFaulty(uint64_t seed, const std::string& log);

}  // namespace tread::testing
