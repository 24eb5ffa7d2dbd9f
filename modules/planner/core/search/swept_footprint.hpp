// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "modules/planner/core/search/pattern_table.hpp"

namespace tread::planner {

/// A step for a footprint with at most this margin [m].
/** No coarser than `step`, and fine enough that a short vehicle skips nothing. */
SweepResolution resolutionFor(const FootprintSize& size, double margin, SweepResolution step);

/// Poses along a trajectory of equal periods, without the origin, at most a step apart.
std::vector<SweptPose> sampleSweep(const std::vector<Pose2>& trajectory, double period,
                                   const SweepResolution& step);

/// The poses of a trajectory's sweep that suffice for a footprint.
SweptFootprint sweptFootprintOf(const std::vector<SweptPose>& sweep,
                                const std::vector<Pose2>& trajectory, double period,
                                const SweepResolution& step);

/// Pose along a trajectory of equal periods, `time` [s] after its start; held at both ends.
Pose2 poseAlong(const std::vector<Pose2>& trajectory, double period, double time);

}  // namespace tread::planner
