// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/log/event_log.hpp"

namespace tread::blind {

/// Kinds of defects: of the whole log, from some time on, or for a while.
const std::vector<std::string>& defectNames();

/// A defect of a log.
struct Defect {
  double keep = 1.0;  ///< share of the file's bytes that is kept
  std::string where;  ///< in words
};

/// Damages a log. `other` is a second robot's log, for two_robots only. Throws
/// std::invalid_argument for an unknown defect.
Defect spoil(const std::string& defect, uint64_t seed, const std::vector<LogEvent>& other,
             std::vector<LogEvent>& events);

}  // namespace tread::blind
