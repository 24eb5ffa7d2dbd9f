// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <string>

#include "common/bus/channels.hpp"

namespace tread::replay {

/// The parts of pattern sets by version and part number.
using SetParts = std::map<int64_t, std::map<int32_t, pattern_set_part_t>>;

/// The first thing in which two parts of the same version differ, in words: version, pattern,
/// field, sample, both values; empty if they are equal. `seq` is not compared.
/** `tolerance` of numbers [m, rad, m2 ...]; 0 = to the bit, and only then checksums are compared.
 */
std::string differenceOf(const pattern_set_part_t& log, const pattern_set_part_t& replay,
                         double tolerance = 0.0);

/// The same for two reports on one execution.
std::string differenceOf(const learning_t& log, const learning_t& replay, double tolerance = 0.0);

}  // namespace tread::replay
