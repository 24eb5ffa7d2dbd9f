// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <set>
#include <string>
#include <vector>

namespace tread {

/// The first field in which two messages of one of Tread's types differ, as "running.command[1][0]:
/// log 0.5, replay 0.25"; empty if they are equal. Fields named in `without` are not compared.
/** Numbers may differ by `tolerance`; 0 = to the bit, so that an unknown number equals itself.
 * Throws std::invalid_argument if the bytes are no messages of the type. */
std::string differenceBetween(const std::string& type, const std::vector<uint8_t>& log,
                              const std::vector<uint8_t>& replay, double tolerance,
                              const std::set<std::string>& without);

template <class Message>
std::string differenceBetween(const Message& log, const Message& replay, double tolerance,
                              const std::set<std::string>& without) {
  const auto bytesOf = [](const Message& message) {
    std::vector<uint8_t> bytes(static_cast<size_t>(message.getEncodedSize()));
    message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
    return bytes;
  };
  return differenceBetween(Message::getTypeName(), bytesOf(log), bytesOf(replay), tolerance,
                           without);
}

}  // namespace tread
