// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "common/bus/channels.hpp"

namespace tread::replay {

/// The first field in which a message of the log and one of the replay differ, in words, with both
/// values; empty if they are equal. `seq` is never compared.
/** `tolerance` of numbers [m, rad, m2 ...]; 0 = to the bit, and only then checksums are compared.
 */
std::string differenceOf(const pattern_set_part_t& log, const pattern_set_part_t& replay,
                         double tolerance);
std::string differenceOf(const learning_t& log, const learning_t& replay, double tolerance);
/// To the bit; what the planner had received is not compared.
std::string differenceOf(const program_t& log, const program_t& replay);
/// To the bit; `search_time` is not compared.
std::string differenceOf(const plan_t& log, const plan_t& replay);

}  // namespace tread::replay
