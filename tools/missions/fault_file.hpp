// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "common/bus/fault_plan.hpp"

namespace tread::missions {

/// Reads a fault file: `messages` (channel, receiver, drop, duplicate, corrupt, reorder, reorder_s,
/// delay_s, from_s, until_s) and `nodes` (node, kill_at_s, restart_after_s). Throws ConfigError
/// with file:line.
FaultPlan readFaultFile(const std::string& path);

}  // namespace tread::missions
