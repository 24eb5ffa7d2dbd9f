// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/log/event_log.hpp"

namespace tread {

/// Writes the bytes of a message anew that was logged while its type had other fields
/// (lcmtypes/before): by the names of its fields (common/types/renewal.hpp), and MOTOR, PROGRAM and
/// PATTERN_SET with a left and a right command. What cannot be decoded stays as it is.
void renew(LogEvent& event);

}  // namespace tread
