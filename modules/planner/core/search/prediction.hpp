// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "modules/planner/core/map/collision_checker.hpp"
#include "modules/planner/core/search/pattern_table.hpp"

namespace tread::planner {

/// A pose expected at a time from now on.
struct ExpectedPose {
  Pose2 T_map_body;
  double time = 0.0;  ///< [s] from the measurement that it is based on
};

/// What is left of a pattern, laid on the newest measured pose.
struct Prediction {
  std::vector<ExpectedPose> ahead;  ///< poses still to come, the end last
  Pose2 T_map_end;
  double time_left = 0.0;   ///< [s] from the measurement to the end
  Uncertainty uncertainty;  ///< of the end, in map axes
};

/// Whether a pattern leads elsewhere than was expected when the plan behind it was made.
/** Its end as it is expected now lies more than three standard deviations from where it was
 * expected then, and more than 10 cm or .1 rad: less is not worth a plan. */
bool leftCorridor(const Prediction& then, const Prediction& now);

/// How much of what a running pattern promised has come true so far, each about 1.
struct MotionRatio {
  double way = 1.0;
  double turn = 1.0;
};

/// Compares the motion since the start of a running pattern with what was expected of it up to
/// `time` [s].
/** Little motion tells little: the ratios are drawn towards 1 by as much motion as INS noise and a
 * moment's disturbance may make. Within 0.6 and 1.6. */
MotionRatio motionRatio(const Pose2& T_start_now, double time, const TablePattern& pattern,
                        double period);

/// What is left of a pattern that has been running for `time` [s] when the vehicle was measured at
/// a pose.
/** What is left is scaled by what has come true so far: on ground that turns the vehicle more than
 * expected it will go on to do so. A negative time: it will begin that much later; until then the
 * vehicle keeps the twist of its entry class. */
Prediction predict(const Pose2& T_map_body, double time, const TablePattern& pattern,
                   const PatternTable& table, const MotionRatio& so_far = {});

/// Time until the first of the poses that is not free with a margin level [s]; nothing if all are
/// free.
std::optional<double> firstConflict(const CollisionChecker& collision_checker,
                                    const std::vector<ExpectedPose>& poses, int level);

}  // namespace tread::planner
