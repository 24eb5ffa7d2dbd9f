// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>

#include "common/seal/seal.hpp"

namespace tread {

/// Reads a key: a text file with 64 hexadecimal digits and comment lines (#), owned by this
/// process's user and readable and writable by nobody else.
/** Throws std::runtime_error, one line: what, where, what to do. */
SealKey readKey(const std::string& path);

/// Creates a new key in a new file with mode 0600; throws std::runtime_error if the file exists or
/// cannot be written.
void writeNewKey(const std::string& path);

/// The same if there is no file yet, safe against concurrent calls. True if this call created it.
bool ensureKey(const std::string& path);

/// Identifies a key without revealing it: "3f2a-90bc-17de-55a1".
std::string fingerprint(const SealKey& key);

/// The sealer of a process on the robot's host, for its CLOCK_MONOTONIC; none where `path` is
/// empty. Throws as readKey() does.
std::optional<Sealer> hostSealer(const std::string& path);

/// The same for a program that may run on another host: it adopts session and clock of the first
/// message received, and seals nothing until then.
std::optional<Sealer> stationSealer(const std::string& path);

}  // namespace tread
