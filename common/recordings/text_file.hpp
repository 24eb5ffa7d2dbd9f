// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

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

/// Throws std::runtime_error if an output would replace one of the inputs, by whatever name.
void refuseToReplace(const std::string& output, const std::vector<std::string>& inputs);

/// Before the work: throws with one line if an output, of which empty ones are none, would replace
/// an input or another output, or cannot be written.
void checkOutputs(const std::vector<std::string>& outputs, const std::vector<std::string>& inputs);

/// Writes a file whole or not at all, over what is there, but never over one of the inputs; throws
/// std::runtime_error with one line.
void writeOutput(const std::string& path, const std::string& text,
                 const std::vector<std::string>& inputs);

}  // namespace tread::recordings
