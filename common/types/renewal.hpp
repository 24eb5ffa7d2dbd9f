// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tread {

/// Converts a message of a channel that was logged while its type had fewer fields
/// (lcmtypes/before, a folder for each day on which types changed).
/** Fields are matched by name. A field missing in the message becomes unknown: NaN, empty, or 0;
 * one whose name ends in _code is derived from the words beside it (stopReasonOf()). False if the
 * bytes are of no older type; they stay unchanged then. */
bool renewByNames(const std::string& channel, std::vector<uint8_t>& bytes);

}  // namespace tread
