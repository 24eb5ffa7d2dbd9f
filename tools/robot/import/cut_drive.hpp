// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <optional>
#include <string>
#include <vector>

#include "common/recordings/imported_log.hpp"
#include "common/recordings/recordings.hpp"

// How a drive whose commands stay for a while becomes executions of patterns, which
// tread-experiment takes:
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

/// How drives are cut.
struct CutLayout {
  double length = 2.0;  ///< [s] of a piece, whole periods
  double settle = 1.2;  ///< [s] after a change of command that no piece begins in
  double alike = 0.0;   ///< [1] commands that differ by up to this share of the largest one are one
  size_t fewest = 8;    ///< pieces of a pattern on each surface
};

/// A piece of a drive under one command.
struct CutPiece {
  Command command;
  recordings::Execution poses;
  double begin = 0.0;  ///< [s] in its drive
  size_t run = 0;      ///< index of the command that was held, in the drive's runs
};

/// A part of a drive that is in no piece.
struct UncutPart {
  size_t count = 0;
  double seconds = 0.0;
};

/// What was cut of the drives on a surface.
struct CutSurface {
  std::string name;
  CommandChannels channels;
  double seconds = 0.0;  ///< under commands other than zero
  std::vector<CutPiece> pieces;
  std::map<std::string, UncutPart> left_out;  ///< by reason
};

/// Cuts a drive and adds its pieces to those of its surface.
/** Throws RecordingError if the channels of its commands are not those of the drives before. */
void cutDrive(const recordings::RecordedDrive& drive, const CutLayout& layout, CutSurface& surface);

/// Recordings of patterns made of pieces, and what was left out of them, in words.
struct CutRecordings {
  recordings::PatternRecordings recordings;
  std::vector<std::string> notes;
};

/// The patterns that all surfaces have, or those of a set that is there already, with their pieces.
/** A command's class is its own steady motion, the mean over the surfaces. Throws RecordingError if
 * surfaces have other channels, no command has enough pieces on all of them, or the set's patterns
 * are not one command held for a piece. */
CutRecordings recordingsOf(const std::vector<CutSurface>& surfaces, const CutLayout& layout,
                           const std::optional<PatternSet>& known);

/// The name of a pattern that holds a command: left+0.5_right+0.3; channels at 0 are left out.
std::string patternName(const Command& command, const CommandChannels& channels);

}  // namespace tread::import
