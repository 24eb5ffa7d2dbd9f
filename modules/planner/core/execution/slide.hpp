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
  double deceleration = 0.0;        ///< [m/s2] largest change of its velocity on this ground
};

/// A motion requested by the drive for a while [s].
struct AskedMotion {
  Twist2 v_body;
  double seconds = 0.0;
};

/// Whether a vehicle slides: it moves sideways or onwards although its pattern does not.
bool slides(const Twist2& measured, const Twist2& asked);

/// The motions requested in the rest of a pattern from a time on [s].
std::vector<AskedMotion> askedFrom(const MotionPattern& pattern, double period, double time);

/// The speed at which a sliding vehicle hits a cell that is not free [m/s]; 0 if it does not during
/// the requested motions and the stop after them.
/** Its velocity approaches the requested one no faster than the ground allows: a locked track
 * slides straight on. Its heading follows the drive, which needs much less grip. */
double impactSpeed(const CollisionChecker& around, Sliding vehicle,
                   const std::vector<AskedMotion>& asked);

/// Options of a sliding vehicle: continue, stop at once, or replace the next pattern.
struct SlideChoices {
  std::vector<AskedMotion> rest;               ///< of the running pattern
  const TablePattern* next = nullptr;          ///< that follows; nullptr = it stops
  std::vector<const TablePattern*> followers;  ///< alternatives to it
};

/// The answer that was chosen.
struct SlideAnswer {
  enum class Kind { kGoOn, kStop, kFollow };
  Kind kind = Kind::kGoOn;
  const TablePattern* follower = nullptr;  ///< of kFollow
  double impact = 0.0;                     ///< [m/s] at the first contact; 0 = no contact
};

/// Chooses the option without contact, or with the slowest one; keeps the present motion unless
/// another option is better.
SlideAnswer answerToSlide(const CollisionChecker& around, const Sliding& vehicle,
                          const SlideChoices& choices, double period);

}  // namespace tread::planner
