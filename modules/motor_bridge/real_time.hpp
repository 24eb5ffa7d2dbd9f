// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

namespace tread::motor {

/// Locks the process into memory and gives the calling thread a fixed priority (SCHED_FIFO), so
/// that commands leave regularly on a busy host. Returns one line with what the system does not
/// allow and the remedy; empty = everything was allowed.
std::string becomeRealTime();

}  // namespace tread::motor
