// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cmath>
#include <vector>

#include "common/geometry/footprint_size.hpp"
#include "common/geometry/se2.hpp"

namespace tread::planner {

/// A pose along a pattern, relative to its start, with its turn worked out.
struct SweptPose {
  Pose2 pose;
  double cos_yaw = 1.0;
  double sin_yaw = 0.0;
  double time = 0.0;   ///< [s] from the start of the pattern
  double reach = 0.0;  ///< [m] that a point of the outline has moved since then, about
};

/// How finely a pattern is sampled for collision checks.
struct SweepResolution {
  double distance = 0.10;  ///< [m]
  double turn = 0.105;     ///< [rad]
  /// [m] The footprint's sweep over so much of a straight way is the footprint at both ends, if it
  /// is at least so long: the search checks no more poses than that, and as many as turns need.
  double covered = 0.3;
  /// The largest footprint that is asked about, margins included: how far its corners swing.
  FootprintSize outline;
};

/// A step for a footprint that is asked about with at most such a margin [m].
/** No coarser than `step`, and so fine that a short vehicle jumps over nothing. */
SweepResolution resolutionFor(const FootprintSize& size, double margin, SweepResolution step);

/// A disc around ground that a corner of the outline passes over between two poses that are checked
/// and that lies under neither of these; in the axes of the sweep's start.
struct CornerDisc {
  float x = 0.0F;       ///< [m] its centre
  float y = 0.0F;       ///< [m]
  float out_x = 0.0F;   ///< [m per m] how far the centre moves for each metre of margin
  float out_y = 0.0F;   ///< [m per m]
  float radius = 0.0F;  ///< [m]
  float spread = 0.0F;  ///< [m per m] what is to be added to it for each metre of other margin
  int way = 0;          ///< the one that ends at the cover's pose of this number
};

/// A pose of a sweep that is always checked, and the way to it from the one before.
struct CheckedPose {
  SweptPose at;
  /// What else to check if not all discs of the way are free: SweptFootprint::between from the
  /// first.
  size_t first_between = 0;
  size_t between_count = 0;
};

/// The poses of a sweep that a footprint needs, the start left out, the end last.
struct SweptFootprint {
  std::vector<CheckedPose> poses;
  std::vector<CornerDisc> discs;
  std::vector<SweptPose> between;
  double front = 0.0;  ///< [m] of the outline that they were worked out for
};

/// Poses along a trajectory of equal periods, the origin left out, neighbours at most a step apart.
std::vector<SweptPose> sampleSweep(const std::vector<Pose2>& trajectory, double period,
                                   const SweepResolution& step);

/// Those poses of the sweep of a trajectory that are enough for a footprint.
SweptFootprint sweptFootprintOf(const std::vector<SweptPose>& sweep,
                                const std::vector<Pose2>& trajectory, double period,
                                const SweepResolution& step);

/// Pose along a trajectory of equal periods, `time` [s] after its start; held at both ends.
Pose2 poseAlong(const std::vector<Pose2>& trajectory, double period, double time);

}  // namespace tread::planner
