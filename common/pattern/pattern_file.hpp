// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "common/pattern/pattern.hpp"

namespace tread {

/// Reads a pattern file (YAML that people read and edit; see config/patterns).
/** Throws ConfigError with one line "file:line: what is wrong; what is allowed" for bad YAML,
 * unknown keys, commands and trajectory of different lengths, NaN and everything that
 * PatternSet::make refuses. */
PatternSet readPatternFile(const std::string& path);

/// The same from text; `name` stands for the file in messages.
PatternSet parsePatterns(const std::string& text, const std::string& name);

/// Text of a pattern file. parsePatterns(formatPatterns(set)) has the same content and checksum,
/// bit for bit.
std::string formatPatterns(const PatternSet& set);

}  // namespace tread
