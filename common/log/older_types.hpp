// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/log/event_log.hpp"

namespace tread {

/// Converts a message that was logged with an older type (lcmtypes/before): by field names
/// (common/types/renewal.hpp), and MOTOR, PROGRAM and PATTERN_SET with a left and a right command.
/// What cannot be decoded stays unchanged.
void renew(LogEvent& event);

}  // namespace tread
