// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/drive/drive_log.hpp"
#include "common/pattern/pattern.hpp"
#include "common/recordings/csv_table.hpp"

// Recordings: what patterns really did, executed many times on one surface each (RP_S, section V.A
// of the paper). They lie in a folder:
//   patterns.yaml    the pattern set that was executed (commands, classes; predictions do not
//                    matter)
//   SURFACE.csv      a surface: pattern,execution,sample,x_m,y_m,yaw_rad; sample counts from 1, the
//                    pose after that command relative to the start, yaw unwrapped. The rows of an
//                    execution stand together; executions of a pattern have rising numbers from 1,
//                    with gaps where some were taken out by hand. Lines that begin with # are
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

/// Throws RecordingError unless there are recordings of as many patterns as the set has.
void requireSamePatternCount(const SurfaceRecordings& surface, const PatternSet& set);

/// Whether an execution has as many poses as that, all of them finite.
bool isWhole(const Execution& poses, size_t samples);

/// Throws RecordingError for what readRecordings() would refuse: another number of patterns, a
/// pattern without an execution, one that is not whole, names that files cannot hold.
void requireReadable(const SurfaceRecordings& surface, const PatternSet& set);

/// Recordings of one pattern set on several surfaces.
struct PatternRecordings {
  PatternSet patterns;
  std::vector<SurfaceRecordings> surfaces;
};

/// Reads a folder, its surfaces sorted by name; throws RecordingError.
PatternRecordings readRecordings(const std::string& folder);
/// Writes a folder, which is made if needed; files of other surfaces there stay. Throws
/// RecordingError.
void writeRecordings(const std::string& folder, const PatternRecordings& recordings);

/// Reads the text of a surface's file; `path` stands for it in messages.
/** The rows of an execution stand together, samples counting from 1 to the pattern's number of
 * commands; executions of a pattern have rising numbers, with gaps where some were taken out, and
 * patterns may take turns. Throws RecordingError at file:line. */
SurfaceRecordings parseSurface(const std::string& text, const std::string& path,
                               const std::string& surface, const PatternSet& patterns);
/// Text of a surface's file; parseSurface() of it gives the same numbers, bit for bit.
std::string formatSurface(const SurfaceRecordings& recordings, const PatternSet& patterns);

/// Refuses what could not be added later, before anything is driven for it: a bad name, a folder
/// that cannot be made or written to, recordings of other patterns.
/** Order, names, classes, commands, kind and period must be the same, since recordings count only
 * for what was executed; a folder without recordings is fine. Throws RecordingError. */
void requireAddable(const std::string& folder, const PatternSet& executed,
                    const std::string& surface);

/// Adds a surface to a folder of recordings, or replaces it.
/** patterns.yaml that is there already stays as it is. Returns whether the surface was there
 * before. Throws RecordingError as above and as writeRecordings() does. */
bool addSurface(const std::string& folder, const PatternSet& executed,
                const SurfaceRecordings& surface);

/// What averaging left out of one pattern, and why.
struct AverageNote {
  std::string pattern;
  int used = 0;
  bool by_twist = false;              ///< body twists were averaged, not poses: the turn is strong
  std::vector<std::string> rejected;  ///< a line for each execution that was left out
  std::vector<size_t> left_out;       ///< the same executions by index, from 0
};

/// When an execution is no fair one, and how few are too few.
struct AverageLimits {
  double strong_turn = 0.5;  ///< [rad] from here on twists are averaged
  double max_speed = 0.0;    ///< [m/s] of a step, over 0.1 s; 0 = 1.5 times the median's largest
  int min_executions = 3;    ///< fewer fair ones are refused
};

/// IP_S: the set with averaged trajectories and the recorded spread of each end as its covariance.
/** Strong turns are averaged as body twists sample by sample, because the mean of poses is shorter
 * than any of them. The spread is about the mean of the end poses (n - 1). An execution of another
 * length, with a number that is not finite, an impossible speed or a jump of yaw is left out and
 * noted, one note a pattern in the order of the set. Name, version and classes stay; times_learned
 * is 0. Throws RecordingError if a pattern has too few. */
PatternSet averageSet(const PatternSet& patterns, const SurfaceRecordings& recordings,
                      const AverageLimits& limits, std::vector<AverageNote>& notes);

// Recordings as a robot would have sent them, so that the real learner process can hear them. First
// all executions on one surface, then those on the other; MARK names the surface. Each execution is
// a track of its own: INS and MOTOR tell of it from `lead` before its start to `tail` after its
// end, and are silent between two. The windows that the recordings come from are steady, so before
// its first and after its last pose the robot is taken to move by the mean twist of the recording
// (that of its first sample alone would be mostly noise of the lidar's poses).
//   INS        100 Hz; between two recorded poses by the constant twist that leads from one to the
//              other
//   MOTOR      20 Hz, the steady command; execution and index while the pattern is played
//   EXECUTION  on start and end, the last eight records; they name the version of the shipped set

struct ExecutionLogRequest {
  int executions = 40;   ///< on each surface; patterns take turns in drawn order
  uint64_t seed = 1;     ///< draws that order, and which recordings are played
  double lead = 0.5;     ///< [s]
  double tail = 0.3;     ///< [s]
  double silence = 1.0;  ///< [s] between two executions
};

/// The log; `shipped` is the set that the executions name, with the patterns of the recordings.
/** Throws RecordingError if they do not fit. Same arguments, same bytes. */
std::vector<LogEvent> executionLog(const PatternSet& shipped, const SurfaceRecordings& from,
                                   const SurfaceRecordings& to, const ExecutionLogRequest& request);

}  // namespace tread::recordings
