// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "common/recordings/recordings.hpp"

namespace tread::recordings {

/// The header line of a surface's file.
inline constexpr const char* kSurfaceHeader = "pattern,execution,sample,x_m,y_m,yaw_rad";

/// Reads the text of a surface's file; `path` stands for it in messages.
/** The rows of an execution stand together, samples counting from 1 to the pattern's number of
 * commands; executions of a pattern have rising numbers, with gaps where some were taken out, and
 * patterns may take turns. Throws RecordingError at file:line. */
SurfaceRecordings parseSurface(const std::string& text, const std::string& path,
                               const std::string& surface, const PatternSet& patterns);

/// Text of a surface's file; parseSurface() of it gives the same numbers, bit for bit.
std::string formatSurface(const SurfaceRecordings& recordings, const PatternSet& patterns);

}  // namespace tread::recordings
