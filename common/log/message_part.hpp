// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>

#include "common/log/event_log.hpp"

namespace tread {

/// What of a channel a message replaces: of MAP the same tile, of HEALTH and CONFIG the same
/// process, of PATTERN_SET the same part, of FENCE the same name, of the others the message before.
uint64_t partOf(const LogEvent& event);

}  // namespace tread
