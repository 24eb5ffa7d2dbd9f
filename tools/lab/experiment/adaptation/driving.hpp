// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/geometry/se2.hpp"
#include "common/pattern/pattern.hpp"
#include "common/soundness/core/drive.hpp"

// Recorded driving as a learner meets it: pieces of two seconds, each a command series and the
// trajectory that was measured, one behind the other. What a pattern is to the robot a piece is
// here. Longer predictions are pieces in a chain, as in the planner.
namespace tread::adaptation {

inline constexpr double kPeriod = 0.05;      ///< [s] a sample
inline constexpr size_t kPieceSamples = 40;  ///< of a piece: 2 s
inline constexpr size_t kParts = 4;          ///< of a piece, for what depends on the speed
inline constexpr double kLongestGap = 0.6;   ///< [s] of the poses that is interpolated

/// Driving under known commands without a break, sample by sample.
struct SampledSegment {
  TrackCommand before;                 ///< held before the first command
  bool entry_known = false;            ///< whether it was; else the motion at the beginning is not
  std::vector<TrackCommand> commands;  ///< the t-th acts from pose t to pose t + 1
  std::vector<Pose2> poses;            ///< one more; NaN where nothing was measured
};

/// Two seconds of driving: poses at all samples are measured, and something moved.
struct SampledPiece {
  size_t segment = 0;
  size_t begin = 0;             ///< sample
  std::vector<Pose2> measured;  ///< after each command, relative to the start, yaw unwrapped
  Eigen::Vector3d mean_twist;   ///< of it [m/s, m/s, rad/s]
};

/// One recording: a vehicle on one ground.
struct SampledSession {
  std::string name;
  std::string vehicle;
  std::string surface;
  CommandKind kind = CommandKind::kTrackSpeed;
  double baseline = 1.0;  ///< [m] that turns track commands into (v, w)
  std::vector<SampledSegment> segments;
  std::vector<SampledPiece> pieces;  ///< in order of time

  /// Whether piece i + 1 begins where piece i ends.
  bool goesOn(size_t i) const {
    return i + 1 < pieces.size() && pieces[i + 1].segment == pieces[i].segment &&
           pieces[i + 1].begin == pieces[i].begin + kPieceSamples;
  }
};

/// Samples of a segment of a drive; poses along the arc between fixes at most kLongestGap apart.
SampledSegment sampled(const gap::Segment& recorded, bool entry_known);

/// Cuts the segments of a session into pieces.
void cutPieces(SampledSession& session);

/// What was read, and a line for each recording that is of no use.
struct Recordings {
  std::vector<SampledSession> sessions;  ///< with at least one piece
  std::vector<std::string> notes;
};

/// Reads a folder of drives (sessions.csv) or of LCM logs (*.lcmlog).
/** Steps that were recorded apart are joined where one went on into the next. Of a log, the vehicle
 * is what its import says, the surface what its first mark says. Throws with one line if there is
 * nothing to read. */
Recordings readRecordings(const std::string& folder);

}  // namespace tread::adaptation
