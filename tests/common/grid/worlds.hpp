// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <random>

#include "common/grid/grid.hpp"

namespace tread {

/// A random grid: obstacle or unknown with these probabilities, else free with a cost.
inline Grid randomGrid(std::mt19937_64& random, CellIndex lower, int width, int height,
                       double obstacles, double unknowns) {
  Grid grid(0.1, lower, width, height);
  std::uniform_real_distribution<double> draw(0.0, 1.0);
  for (Cell& cell : grid.cells()) {
    const double u = draw(random);
    cell = u < obstacles              ? kObstacle
           : u < obstacles + unknowns ? kUnknown
                                      : static_cast<Cell>(100.0 * draw(random));
  }
  return grid;
}

/// Distance from a point to the area of a cell [m].
inline double distanceToCell(const Eigen::Vector2d& p_map, CellIndex cell, double cell_size) {
  const Eigen::Vector2d lower(cell.x * cell_size, cell.y * cell_size);
  const Eigen::Vector2d upper = lower + Eigen::Vector2d(cell_size, cell_size);
  const Eigen::Vector2d nearest = p_map.cwiseMax(lower).cwiseMin(upper);
  return (p_map - nearest).norm();
}

}  // namespace tread
