// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>

#include "common/log/event_log.hpp"

namespace tread {

/// Identifies what a message replaces on its channel: for MAP the same tile, for HEALTH and CONFIG
/// the same process, for PATTERN_SET the same part, for FENCE the same name, otherwise the previous
/// message.
uint64_t partOf(const LogEvent& event);

}  // namespace tread
