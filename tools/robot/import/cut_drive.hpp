// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/recordings/imported_log.hpp"
#include "common/recordings/recordings.hpp"

// Cuts a drive with piecewise constant commands into executions of patterns, as tread-experiment
// reads them:
//   1. From `settle` after a change of command on, each command that goes on is cut into pieces of
//      `length`: the motion is steady, so a piece enters as it goes on.
//   2. A piece without a gap of the poses is an execution: a pose after each period of 50 ms,
//      relative to its beginning.
//   3. A command that has enough pieces on every surface is a pattern, named after the command.
//      With `alike`, commands nearby count as that one: their pieces are corrected by what the
//      difference of the commands makes on that surface, twist = B u, B by least squares over all
//      of its pieces.
// What is left out is counted by its reason. Units: m, rad, s.
namespace tread::import {

/// Parameters of the cutting.
struct CutLayout {
  double length = 2.0;  ///< [s] length of a piece, a multiple of the period
  double settle = 1.2;  ///< [s] after a change of command in which no piece begins
  /// [1] commands that differ by at most this share of the largest are one pattern
  double alike = 0.0;
  size_t fewest = 8;  ///< minimum pieces of a pattern on each surface
};

/// A part of a drive under a constant command.
struct CutPiece {
  Command command;
  recordings::Execution poses;
  double begin = 0.0;  ///< [s] in its drive
  size_t run = 0;      ///< index of the command in the drive's runs
};

/// A part of a drive that is in no piece.
struct UncutPart {
  size_t count = 0;
  double seconds = 0.0;
};

/// Result of cutting the drives on one surface.
struct CutSurface {
  std::string name;
  CommandChannels channels;
  double seconds = 0.0;  ///< under non-zero commands
  std::vector<CutPiece> pieces;
  std::map<std::string, UncutPart> left_out;  ///< by reason
};

/// Cuts a drive and adds its pieces to those of its surface.
/** Throws RecordingError if its command channels differ from those of the earlier drives. */
void cutDrive(const recordings::RecordedDrive& drive, const CutLayout& layout, CutSurface& surface);

/// Recordings of patterns, and a description of what was left out.
struct CutRecordings {
  recordings::PatternRecordings recordings;
  std::vector<std::string> notes;
};

/// Makes the patterns that all surfaces have in common, or takes those of an existing set, and
/// assigns the pieces.
/** The motion class of a pattern is its own steady motion, averaged over the surfaces. Throws
 * RecordingError if surfaces differ in their channels, if no command has enough pieces on all of
 * them, or if a pattern of the set is not one constant command over a piece. */
CutRecordings recordingsOf(const std::vector<CutSurface>& surfaces, const CutLayout& layout,
                           const std::optional<PatternSet>& known);

/// Name of a pattern of constant command, for instance left+0.5_right+0.3; channels at 0 are
/// omitted.
std::string patternName(const Command& command, const CommandChannels& channels);

}  // namespace tread::import
