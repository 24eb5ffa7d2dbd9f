// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "common/bus/channels.hpp"

namespace tread::replay {

/// The first field in which two programs differ, in words; empty if they are equal to the bit.
/// Neither `seq` nor what the planner had heard is compared.
std::string differenceOf(const program_t& log, const program_t& replay);

/// The same for two plans; neither `seq` nor `search_time` is compared.
std::string differenceOf(const plan_t& log, const plan_t& replay);

}  // namespace tread::replay
