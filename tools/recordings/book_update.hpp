// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "tools/recordings/recordings.hpp"

namespace tread::recordings {

/// Refuses a folder that is a book of other patterns: order, names, classes, commands, kind and
/// period must be the same, since recordings count only for what was executed.
/** A folder that is no book yet is fine. Throws RecordingError. */
void requireSamePatterns(const std::string& folder, const PatternSet& executed);

/// Adds a surface to a book, or replaces it; the folder becomes a book of this set if it is none.
/** patterns.yaml of a book that is there stays as it is. Returns whether the surface was there
 * before. Throws RecordingError as above and as writeBook() does. */
bool addToBook(const std::string& folder, const PatternSet& executed,
               const SurfaceRecordings& surface);

}  // namespace tread::recordings
