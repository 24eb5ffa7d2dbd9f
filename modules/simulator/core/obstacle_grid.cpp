// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/core/obstacle_grid.hpp"

namespace tread::sim {
namespace {

constexpr double kMostCells = 1e6;

}  // namespace

ObstacleGrid::ObstacleGrid(const std::vector<Obstacle>& obstacles, double cell_edge)
    : edge_(cell_edge) {
  if (obstacles.empty()) return;
  Extent all = extentOf(obstacles.front());
  std::vector<Extent> extents;
  for (const Obstacle& obstacle : obstacles) {
    extents.push_back(extentOf(obstacle));
    all.low = all.low.cwiseMin(extents.back().low);
    all.high = all.high.cwiseMax(extents.back().high);
  }
  // A rim of one millimetre keeps shapes that end on a cell border inside the grid.
  low_ = all.low.array() - 1e-3;
  edge_ = std::max(edge_, std::sqrt((all.high - all.low).prod() / kMostCells));
  edge_ = std::max(edge_, (all.high - all.low).maxCoeff() / kMostCells);
  columns_ = column(all.high.x() + 1e-3) + 1;
  rows_ = row(all.high.y() + 1e-3) + 1;

  std::vector<std::vector<uint32_t>> cells(cell(0, rows_));
  for (uint32_t i = 0; i < extents.size(); ++i) {
    for (int y = row(extents[i].low.y()); y <= row(extents[i].high.y()); ++y) {
      for (int x = column(extents[i].low.x()); x <= column(extents[i].high.x()); ++x)
        cells[cell(x, y)].push_back(i);
    }
  }
  for (const auto& list : cells) {
    starts_.push_back(static_cast<uint32_t>(indices_.size()));
    indices_.insert(indices_.end(), list.begin(), list.end());
  }
  starts_.push_back(static_cast<uint32_t>(indices_.size()));
}

Crossing ObstacleGrid::clip(const Eigen::Vector2d& start, const Eigen::Vector2d& direction,
                            double range) const {
  Crossing inside{0.0, range};
  const Eigen::Vector2d high = low_ + edge_ * Eigen::Vector2d(columns_, rows_);
  for (int axis = 0; axis < 2; ++axis) {
    if (direction[axis] == 0.0) {
      if (start[axis] < low_[axis] || start[axis] > high[axis]) return {1.0, 0.0};
      continue;
    }
    const double a = (low_[axis] - start[axis]) / direction[axis];
    const double b = (high[axis] - start[axis]) / direction[axis];
    inside.enter = std::max(inside.enter, std::min(a, b));
    inside.leave = std::min(inside.leave, std::max(a, b));
  }
  return inside;
}

}  // namespace tread::sim
