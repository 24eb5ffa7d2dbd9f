// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

namespace tread::motor {

/// Locks the process into memory and gives the calling thread a fixed priority (SCHED_FIFO), so
/// that commands leave evenly on a busy host. What the system does not allow, with the remedy, in
/// one line; empty = all was allowed.
std::string becomeRealTime();

}  // namespace tread::motor
