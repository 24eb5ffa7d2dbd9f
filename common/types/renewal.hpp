// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

namespace tread {

/// Writes a message of a channel anew that was logged while its type had fewer fields
/// (lcmtypes/before, a folder for each day on which types changed).
/** Fields keep their values by their names. One that the message does not have is unknown: NaN,
 * empty, or 0; where its name ends in _code it is what the words beside it say (stopReasonOf()).
 * False if the bytes are none of an older type; they stay as they are then. */
bool renewByNames(const std::string& channel, std::vector<uint8_t>& bytes);

}  // namespace tread
