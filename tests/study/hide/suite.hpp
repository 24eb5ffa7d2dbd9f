// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "tests/study/hide/blind_case.hpp"

namespace tread::blind {

/// A group that no drive of a kind can distinguish.
struct DegenerateGroup {
  std::vector<std::string> hidden;  ///< one of these is hidden
  std::vector<std::string> right;   ///< correct answers
  Choice choice = Choice::kFull;    ///< drives in which they are equal
};

/// Groups of effects that no drive distinguishes: exact ones, then those of poor drives.
const std::vector<DegenerateGroup>& degenerateGroups();

/// small, medium, full.
const std::vector<std::string>& suiteNames();

/// All cases of a suite in the order of their shuffled names. Short logs (200 s instead of 10 min)
/// have a third of `minutes`. Throws std::invalid_argument for another name. Same seed, same cases.
std::vector<CasePlan> suiteOf(const std::string& name, double minutes, uint64_t seed);

}  // namespace tread::blind
