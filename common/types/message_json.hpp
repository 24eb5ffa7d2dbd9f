// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/types/message_type.hpp"

namespace tread {

// A message as JSON: an object with a member for each field. Numbers that JSON cannot represent are
// texts, as in Protocol Buffers' JSON: "NaN", "Infinity", "-Infinity". Arrays of several dimensions
// are flattened, the last index fastest, because viewers that know messages by their schema do not
// support arrays of arrays. An array of bytes is one base64 text.

/// The message as JSON text; nullopt if the bytes are no message of the type.
std::optional<std::string> jsonOf(const MessageTypes& types, const MessageType& type,
                                  const std::vector<uint8_t>& bytes);

/// The message's bytes from its JSON; throws std::invalid_argument with the field and the error.
/** Unknown members are ignored. Lengths must match: an array has as many values as its type and its
 * length fields require. */
std::vector<uint8_t> bytesOf(const MessageTypes& types, const MessageType& type,
                             const std::string& json);

/// The type as JSON Schema (draft 7) for MCAP and the Foxglove protocol; its descriptions are the
/// comments of the .lcm file.
std::string jsonSchemaOf(const MessageTypes& types, const MessageType& type);

}  // namespace tread
