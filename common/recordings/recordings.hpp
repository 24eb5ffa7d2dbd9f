// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/drive/drive_log.hpp"
#include "common/pattern/pattern.hpp"
#include "common/recordings/csv_table.hpp"

// Recordings: the measured motion of patterns, each executed many times on one surface (RP_S,
// section V.A of the paper). A folder holds:
//   patterns.yaml    the pattern set that was executed (commands, classes; predictions do not
//                    matter)
//   SURFACE.csv      a surface: pattern,execution,sample,x_m,y_m,yaw_rad; sample counts from 1, the
//                    pose after that command relative to the start, yaw unwrapped. The rows of an
//                    execution are consecutive; executions of a pattern have rising numbers from 1,
//                    with gaps where some were removed by hand. Lines that begin with # are
//                    comments. Every pattern has at least one execution on every surface.
// Units: m, rad, s.
namespace tread::recordings {

/// One execution: a pose after each command, as many as the pattern has.
using Execution = std::vector<Pose2>;

/// All executions on one surface.
struct SurfaceRecordings {
  std::string surface;
  std::vector<std::vector<Execution>> executions;  ///< by pattern, in the order of the set
};

/// Throws RecordingError if the number of patterns differs from the set's.
void requireSamePatternCount(const SurfaceRecordings& surface, const PatternSet& set);

/// Whether an execution has this many poses, all of them finite.
bool isWhole(const Execution& poses, size_t samples);

/// Throws RecordingError for anything that readRecordings() would refuse: another number of
/// patterns, a pattern without an execution, an incomplete execution, names that are no file names.
void requireReadable(const SurfaceRecordings& surface, const PatternSet& set);

/// Recordings of one pattern set on several surfaces.
struct PatternRecordings {
  PatternSet patterns;
  std::vector<SurfaceRecordings> surfaces;
};

/// Reads a folder, its surfaces sorted by name; throws RecordingError.
PatternRecordings readRecordings(const std::string& folder);
/// Writes a folder, creating it if needed; files of other surfaces there stay. Throws
/// RecordingError.
void writeRecordings(const std::string& folder, const PatternRecordings& recordings);

/// Reads the text of a surface's file; `path` stands for it in messages.
/** The rows of an execution are consecutive, samples counting from 1 to the pattern's number of
 * commands; executions of a pattern have rising numbers, with gaps where some were removed, and
 * patterns may alternate. Throws RecordingError at file:line. */
SurfaceRecordings parseSurface(const std::string& text, const std::string& path,
                               const std::string& surface, const PatternSet& patterns);
/// Text of a surface's file; parseSurface() of it restores the same numbers, bit for bit.
std::string formatSurface(const SurfaceRecordings& recordings, const PatternSet& patterns);

/// Refuses early, before any driving, what could not be added later: a bad name, a folder that
/// cannot be created or written, recordings of other patterns.
/** Order, names, classes, commands, kind and period must be equal, because recordings are valid
 * only for the commands that were executed; a folder without recordings is fine. Throws
 * RecordingError. */
void requireAddable(const std::string& folder, const PatternSet& executed,
                    const std::string& surface);

/// Adds a surface to a folder of recordings, or replaces it.
/** An existing patterns.yaml stays unchanged. Returns whether the surface existed before. Throws
 * RecordingError as above and as writeRecordings() does. */
bool addSurface(const std::string& folder, const PatternSet& executed,
                const SurfaceRecordings& surface);

// Recordings as a robot would have sent them, so that the real learner process can receive them.
// First all executions on one surface, then those on the other; MARK names the surface. Each
// execution is a track of its own: INS and MOTOR cover it from `lead` before its start to `tail`
// after its end, and are silent in between. The windows behind the recordings are steady, so before
// the first and after the last pose the robot is assumed to move with the recording's mean twist
// (the twist of the first sample alone would be mostly noise of the lidar's poses).
//   INS        100 Hz; between two recorded poses by the constant twist that leads from one to the
//              other
//   MOTOR      20 Hz, the steady command; execution and index while the pattern is played
//   EXECUTION  on start and end, the last eight records; they name the version of the shipped set

}  // namespace tread::recordings
