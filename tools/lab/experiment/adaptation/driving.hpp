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

// Recorded driving as a learner needs it: consecutive pieces of two seconds, each a command series
// with the measured trajectory. A piece corresponds to a pattern. Longer predictions are chains of
// pieces, as in the planner.
namespace tread::adaptation {

inline constexpr double kPeriod = 0.05;      ///< [s] a sample
inline constexpr size_t kPieceSamples = 40;  ///< per piece: 2 s
inline constexpr size_t kParts = 4;          ///< per piece, for dependence on speed
inline constexpr double kLongestGap = 0.6;   ///< [s] longest gap of poses that is interpolated

/// Continuous driving under known commands, in samples.
struct SampledSegment {
  TrackCommand before;                 ///< held before the first command
  bool entry_known = false;            ///< otherwise the initial motion is unknown
  std::vector<TrackCommand> commands;  ///< the t-th acts from pose t to pose t + 1
  std::vector<Pose2> poses;            ///< one more than commands; NaN if not measured
};

/// Two seconds of driving with all poses measured and some motion.
struct SampledPiece {
  size_t segment = 0;
  size_t begin = 0;             ///< sample
  std::vector<Pose2> measured;  ///< after each command, relative to the start, yaw unwrapped
  Eigen::Vector3d mean_twist;   ///< over the piece [m/s, m/s, rad/s]
};

/// One recording of a vehicle on one ground.
struct SampledSession {
  std::string name;
  std::string vehicle;
  std::string surface;
  CommandKind kind = CommandKind::kTrackSpeed;
  double baseline = 1.0;  ///< [m] converts track commands to (v, w)
  std::vector<SampledSegment> segments;
  std::vector<SampledPiece> pieces;  ///< ordered by time

  /// Whether piece i + 1 begins where piece i ends.
  bool goesOn(size_t i) const {
    return i + 1 < pieces.size() && pieces[i + 1].segment == pieces[i].segment &&
           pieces[i + 1].begin == pieces[i].begin + kPieceSamples;
  }
};

/// Samples a segment of a drive; poses are interpolated on arcs between fixes at most kLongestGap
/// apart.
SampledSegment sampled(const gap::Segment& recorded, bool entry_known);

/// Cuts the segments of a session into pieces.
void cutPieces(SampledSession& session);

}  // namespace tread::adaptation
