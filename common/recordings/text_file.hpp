// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

namespace tread::recordings {

/// The whole text of a file; throws std::runtime_error with one line that names it.
std::string readText(const std::string& path);

/// Writes a file whole or not at all: a reader finds the old text or the new one.
/** What is no regular file, /dev/stdout for instance, is written to as it stands. Throws
 * std::runtime_error with one line that names the file. */
void writeText(const std::string& path, const std::string& text);

/// Throws as writeText() would where it is known before that a file cannot be written: for those
/// who work long before they write.
void requireWritable(const std::string& path);

}  // namespace tread::recordings
