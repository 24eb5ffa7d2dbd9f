// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include <Eigen/Core>

#include "common/geometry/se2.hpp"
#include "modules/planner/core/map/collision_checker.hpp"

namespace tread::planner {

/// A vehicle on ground that gives way.
struct Sliding {
  Pose2 T_map_body;
  Eigen::Vector2d v_map{0.0, 0.0};  ///< [m/s]
  double deceleration = 0.0;        ///< [m/s2] the most by which this ground changes its velocity
};

/// A motion that the drive asks for, for a while [s].
struct AskedMotion {
  Twist2 v_body;
  double seconds = 0.0;
};

/// Whether a vehicle slides: it goes sideways, or on, where its pattern does not.
bool slides(const Twist2& measured, const Twist2& asked);

/// What it asks for in the rest of a pattern from a time on [s].
std::vector<AskedMotion> askedFrom(const MotionPattern& pattern, double period, double time);

/// The speed at which a sliding vehicle touches something that is not free [m/s]; 0 if it does not
/// within what is asked and the stop that follows.
/** Its velocity goes towards what is asked no faster than the ground changes it: a locked track
 * slides straight on. Its heading follows the drive, which needs much less of the ground. */
double impactSpeed(const CollisionChecker& around, Sliding vehicle,
                   const std::vector<AskedMotion>& asked);

/// What a sliding vehicle can do: go on, stop at once, or let another pattern follow.
struct SlideChoices {
  std::vector<AskedMotion> rest;               ///< of the running pattern
  const TablePattern* next = nullptr;          ///< that follows it; nullptr = it stops
  std::vector<const TablePattern*> followers;  ///< that may take its place
};

/// The answer that was chosen.
struct SlideAnswer {
  enum class Kind { kGoOn, kStop, kFollow };
  Kind kind = Kind::kGoOn;
  const TablePattern* follower = nullptr;  ///< of kFollow
  double impact = 0.0;                     ///< [m/s] with which it touches something; 0 = nothing
};

/// Chooses what touches nothing, or most slowly; what is under way unless another answer is better.
SlideAnswer answerToSlide(const CollisionChecker& around, const Sliding& vehicle,
                          const SlideChoices& choices, double period);

}  // namespace tread::planner
