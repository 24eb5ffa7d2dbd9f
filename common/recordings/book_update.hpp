// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "common/recordings/recordings.hpp"

namespace tread::recordings {

/// Refuses what is no name of a surface: it is that of its file.
void requireSurfaceName(const std::string& name);

/// Refuses what could not be added later, before anything is driven for it: a bad name, a folder
/// that cannot be made or written to, a book of other patterns.
/** Order, names, classes, commands, kind and period must be the same, since recordings count only
 * for what was executed; a folder that is no book yet is fine. Throws RecordingError. */
void requireAddable(const std::string& folder, const PatternSet& executed,
                    const std::string& surface);

/// Adds a surface to a book, or replaces it; the folder becomes a book of this set if it is none.
/** patterns.yaml of a book that is there stays as it is. Returns whether the surface was there
 * before. Throws RecordingError as above and as writeBook() does. */
bool addToBook(const std::string& folder, const PatternSet& executed,
               const SurfaceRecordings& surface);

}  // namespace tread::recordings
