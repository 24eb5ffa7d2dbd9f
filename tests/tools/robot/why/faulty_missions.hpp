// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

namespace tread::testing {

/// A mission with a single fault, and acceptable causes for a debrief.
struct FaultyMission {
  uint64_t seed = 0;
  std::string fault;             ///< in words
  double from = 0.0;             ///< [s] since the log began
  std::set<std::string> causes;  ///< each is a correct cause
};

/// Number of fault kinds.
size_t faultKinds();

/// Drives the mission of a seed and records it; kind = seed % faultKinds(), the rest is random.
FaultyMission driveFaulty(uint64_t seed, const std::string& log);

}  // namespace tread::testing
