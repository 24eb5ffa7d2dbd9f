// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "common/types/message_type.hpp"

namespace tread {

// A message as JSON: an object with a member for each field. What JSON has no number for is a text,
// as in Protocol Buffers' JSON: "NaN", "Infinity", "-Infinity". Arrays of several dimensions lie
// flat, the last one fastest: viewers that know messages by their schema take no arrays of arrays.
// An array of bytes is one base64 text.

/// The message as JSON text; nothing if the bytes are no message of the type.
std::optional<std::string> jsonOf(const MessageTypes& types, const MessageType& type,
                                  const std::vector<uint8_t>& bytes);

/// The message's bytes from its JSON; throws std::invalid_argument with the field and what is wrong
/// there.
/** Members that the type does not have are left out. Lengths must fit: an array has as many values
 * as its type and the fields that tell its lengths say. */
std::vector<uint8_t> bytesOf(const MessageTypes& types, const MessageType& type,
                             const std::string& json);

/// The type as JSON Schema (draft 7), as MCAP and the Foxglove protocol take it; the comments of
/// the .lcm file are its descriptions.
std::string jsonSchemaOf(const MessageTypes& types, const MessageType& type);

}  // namespace tread
