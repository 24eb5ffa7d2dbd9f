// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <vector>

#include "modules/simulator/core/obstacle.hpp"

namespace tread::sim {

/// Which obstacles reach into which cell of a uniform grid: makes queries independent of their
/// number.
class ObstacleGrid {
 public:
  ObstacleGrid() = default;
  /// Takes the extents of the obstacles (kept by the caller, same order). Cell edge [m]; wider
  /// where the obstacles spread over kilometres.
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
  /// obstacles of each; stops at `range` or when `visit` has returned true for an obstacle of a
  /// cell.
  template <typename Visit>
  void visitAlong(const Eigen::Vector2d& start, const Eigen::Vector2d& direction, double range,
                  Visit&& visit) const;

 private:
  /// Distances along a ray at which it enters and leaves the grid.
  Crossing clip(const Eigen::Vector2d& start, const Eigen::Vector2d& direction, double range) const;

  int column(double x) const { return static_cast<int>(std::floor((x - low_.x()) / edge_)); }
  int row(double y) const { return static_cast<int>(std::floor((y - low_.y()) / edge_)); }
  /// First index of a cell's list; lists of a row lie one after the other.
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
  const Crossing inside = clip(start, direction, range);
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
