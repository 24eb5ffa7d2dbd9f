// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>

#include "common/seal/seal.hpp"

namespace tread {

/// Reads a key: a text file with 64 hexadecimal digits and comment lines (#), which belongs to the
/// user of this process and which nobody else may read or write.
/** Throws std::runtime_error, one line: what, where, what to do. */
SealKey readKey(const std::string& path);

/// Makes a new key in a new file with mode 0600; throws std::runtime_error where there is one, or
/// where it cannot be written.
void writeNewKey(const std::string& path);

/// The same where there is no file yet, whoever else does so at the same time. True if this made
/// it.
bool ensureKey(const std::string& path);

/// Tells keys apart without telling the key: "3f2a-90bc-17de-55a1".
std::string fingerprint(const SealKey& key);

/// The sealer of a process on the robot's host, for its CLOCK_MONOTONIC; none where `path` is
/// empty. Throws as readKey() does.
std::optional<Sealer> hostSealer(const std::string& path);

/// The same for a program that may run on another host: it takes over session and clock of the
/// first message that it hears, and until then seals nothing.
std::optional<Sealer> stationSealer(const std::string& path);

}  // namespace tread
