// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/log/event_log.hpp"

namespace tread {

/// Writes the bytes of a message anew that was logged while its type had other fields
/// (lcmtypes/before): MOTOR, PROGRAM and PATTERN_SET with a left and a right command. Others, and
/// what cannot be decoded, stay as they are.
void renew(LogEvent& event);

}  // namespace tread
