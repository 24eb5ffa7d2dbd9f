// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/pattern/pattern.hpp"

namespace tread::planner::testkit {

/// Track speed follows power with a first-order lag; the body's yaw rate follows the tracks'
/// difference.
struct TrackModel {
  double top_speed = 1.10;  ///< [m/s] at full power
  double gauge = 0.60;      ///< [m]
  double lag = 0.15;        ///< [s]
};

/// State of such a vehicle: pose and the speeds of its tracks [m/s].
struct TrackState {
  Pose2 pose;
  double left = 0.0;
  double right = 0.0;
};

/// Advances it by dt under a power command. `gain` and `turn_gain` [1] are effects of the ground.
TrackState moveOn(TrackState state, Command power, double dt, const TrackModel& model,
                  double gain = 1.0, double turn_gain = 1.0, double drift = 0.0);

/// A set like the paper's, plus start, stop, reverse and turns on the spot, predicted by the model.
/** `turn_error` [1] scales the yaw of all predictions, as before any learning. */
PatternSet samplePatterns(int64_t version = 1, double turn_error = 1.0);

/// A small lattice: steps of 1 m straight and quarter turns, all from rest to rest, 1 s each.
PatternSet latticePatterns();

}  // namespace tread::planner::testkit
