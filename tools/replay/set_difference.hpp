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
/// field, sample, both values; empty if they are equal to the bit. `seq` is not compared.
std::string differenceOf(const pattern_set_part_t& log, const pattern_set_part_t& replay);

/// The same for two reports on one execution.
std::string differenceOf(const learning_t& log, const learning_t& replay);

}  // namespace tread::replay
