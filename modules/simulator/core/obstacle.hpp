// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/geometry/se2.hpp"

namespace tread::sim {

/// An upright prism on the ground: a convex polygon or, without corners, a disc.
struct Obstacle {
  std::string name;                                  ///< for reports; may be empty
  std::vector<Eigen::Vector2d> corners;              ///< p_map, convex, counter-clockwise [m]
  Eigen::Vector2d centre = Eigen::Vector2d::Zero();  ///< of a disc, p_map [m]
  double radius = 0.0;                               ///< of a disc [m]
  double height = 1.0;                               ///< above the ground at its middle [m]

  bool isDisc() const { return corners.empty(); }
};

/// An upright box turned by `yaw`; full lengths [m].
Obstacle boxObstacle(const Pose2& T_map_box, double length, double width, double height);
/// An upright cylinder.
Obstacle discObstacle(const Eigen::Vector2d& centre, double radius, double height);

/// Why an obstacle cannot stand in a world; nothing if it can.
std::optional<std::string> obstacleFault(const Obstacle& obstacle);

/// Axis-aligned box around a shape.
struct Extent {
  Eigen::Vector2d low = Eigen::Vector2d::Zero();
  Eigen::Vector2d high = Eigen::Vector2d::Zero();

  bool contains(const Eigen::Vector2d& p) const {
    return (p.array() >= low.array()).all() && (p.array() <= high.array()).all();
  }
};
Extent extentOf(const Obstacle& obstacle);

/// The part of a horizontal ray inside a shape, as distances from its start [m].
struct Crossing {
  double enter = 0.0;
  double leave = 0.0;
};
/// Where a ray (unit direction) passes through an obstacle; nothing if it misses or lies behind.
/** `enter` is 0 for a ray that starts inside. */
std::optional<Crossing> crossingOf(const Obstacle& obstacle, const Eigen::Vector2d& start,
                                   const Eigen::Vector2d& direction);

/// A rectangle in the body frame, centred at the body origin.
struct Rectangle {
  double length = 0.0;  ///< along x_body [m]
  double width = 0.0;   ///< along y_body [m]
};

/// How deep a rectangle is in an obstacle [m]: the shortest way out; 0 or less if they do not
/// touch.
/** Exact for touching or not; for separate shapes the amount is a lower bound of the gap, negated.
 */
double penetrationOf(const Obstacle& obstacle, const Rectangle& rectangle, const Pose2& T_map_body);

}  // namespace tread::sim
