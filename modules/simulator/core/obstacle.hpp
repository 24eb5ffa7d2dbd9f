// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
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

/// Why an obstacle is invalid; nullopt if it is valid.
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
Extent extentOf(const std::vector<Eigen::Vector2d>& corners);  ///< at least one

/// Whether a point lies in a simple polygon, convex or not (even-odd rule).
bool insidePolygon(const std::vector<Eigen::Vector2d>& corners, const Eigen::Vector2d& p);

/// The part of a horizontal ray inside a shape, as distances from its start [m].
struct RayCrossing {
  double enter = 0.0;
  double leave = 0.0;
};
/// Where a ray (unit direction) passes through an obstacle; nullopt if it misses or the obstacle is
/// behind.
/** `enter` is 0 for a ray that starts inside. */
std::optional<RayCrossing> crossingOf(const Obstacle& obstacle, const Eigen::Vector2d& start,
                                      const Eigen::Vector2d& direction);

/// A rectangle in the body frame, centred at the body origin.
struct Rectangle {
  double length = 0.0;  ///< along x_body [m]
  double width = 0.0;   ///< along y_body [m]
};

/// Penetration of a rectangle into an obstacle [m]: the shortest distance out; 0 or less if they do
/// not touch.
/** The sign is exact; for separate shapes the magnitude is a lower bound of the gap. */
double penetrationOf(const Obstacle& obstacle, const Rectangle& rectangle, const Pose2& T_map_body);

/// The obstacles in each cell of a uniform grid: makes queries independent of their number.
class ObstacleGrid {
 public:
  ObstacleGrid() = default;
  /// Takes the extents of the obstacles (owned by the caller, same order). Cell edge [m]; larger if
  /// the obstacles spread over kilometres.
  ObstacleGrid(const std::vector<Obstacle>& obstacles, double cell_edge);

  /// Calls visit(index) for the obstacles whose extent may touch a box; some may come more than
  /// once.
  template <typename Visit>
  void visitNear(const Extent& box, Visit&& visit) const {
    const int x_low = column(box.low.x()), x_high = column(box.high.x());
    const int y_low = row(box.low.y()), y_high = row(box.high.y());
    for (int y = std::max(0, y_low); y <= std::min(rows_ - 1, y_high); ++y) {
      for (int x = std::max(0, x_low); x <= std::min(columns_ - 1, x_high); ++x) {
        for (uint32_t i = begin(x, y); i < begin(x + 1, y); ++i) visit(indices_[i]);
      }
    }
  }

  /// Walks along a ray cell by cell and calls visit(index, distance at which the cell ends) for the
  /// obstacles of each; stops at `range` or after a cell for which `visit` has returned true.
  template <typename Visit>
  void visitAlong(const Eigen::Vector2d& start, const Eigen::Vector2d& direction, double range,
                  Visit&& visit) const;

 private:
  /// Distances along a ray at which it enters and leaves the grid.
  RayCrossing clip(const Eigen::Vector2d& start, const Eigen::Vector2d& direction,
                   double range) const;

  int column(double x) const { return static_cast<int>(std::floor((x - low_.x()) / edge_)); }
  int row(double y) const { return static_cast<int>(std::floor((y - low_.y()) / edge_)); }
  /// First index of a cell's list; lists of a row are consecutive.
  uint32_t begin(int x, int y) const { return starts_[cell(x, y)]; }
  size_t cell(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(columns_) + static_cast<size_t>(x);
  }

  double edge_ = 1.0;
  Eigen::Vector2d low_ = Eigen::Vector2d::Zero();
  int columns_ = 0;
  int rows_ = 0;
  std::vector<uint32_t> starts_;   ///< columns x rows + 1
  std::vector<uint32_t> indices_;  ///< of obstacles, cell by cell
};

template <typename Visit>
void ObstacleGrid::visitAlong(const Eigen::Vector2d& start, const Eigen::Vector2d& direction,
                              double range, Visit&& visit) const {
  if (columns_ == 0) return;
  const RayCrossing inside = clip(start, direction, range);
  if (inside.enter > inside.leave) return;
  const Eigen::Vector2d entry = start + inside.enter * direction;
  int at[2] = {std::clamp(column(entry.x()), 0, columns_ - 1),
               std::clamp(row(entry.y()), 0, rows_ - 1)};
  const int size[2] = {columns_, rows_};
  int step[2];
  double next[2], per_cell[2];
  for (int axis = 0; axis < 2; ++axis) {
    const double d = direction[axis];
    step[axis] = d > 0.0 ? 1 : -1;
    const double border = low_[axis] + (at[axis] + (d > 0.0 ? 1 : 0)) * edge_;
    next[axis] = d == 0.0 ? std::numeric_limits<double>::infinity() : (border - start[axis]) / d;
    per_cell[axis] = d == 0.0 ? std::numeric_limits<double>::infinity() : edge_ / std::abs(d);
  }
  for (double distance = inside.enter; distance <= inside.leave;) {
    const int axis = next[0] < next[1] ? 0 : 1;
    bool found = false;
    for (uint32_t i = begin(at[0], at[1]); i < begin(at[0] + 1, at[1]); ++i)
      found |= visit(indices_[i], next[axis]);
    if (found) return;
    distance = next[axis];
    at[axis] += step[axis];
    if (at[axis] < 0 || at[axis] >= size[axis]) return;
    next[axis] += per_cell[axis];
  }
}

}  // namespace tread::sim
