// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <random>

#include "common/grid/grid.hpp"

namespace tread::planner::testkit {

/// Random integer from..to, inclusive.
inline int drawn(std::mt19937_64& random, int from, int to) {
  return std::uniform_int_distribution<int>(from, to)(random);
}
inline double drawn(std::mt19937_64& random, double from, double to) {
  return std::uniform_real_distribution<double>(from, to)(random);
}

/// Parameters of a random ground.
struct RandomGround {
  double cell_size = 0.1;  ///< [m]
  CellIndex lower{-40, -30};
  int width = 90;   ///< [cells]
  int height = 80;  ///< [cells]
  int blocks = 12;  ///< rectangles
  int largest = 8;  ///< [cells] longest side
  int specks = 10;  ///< single cells
  int walls = 0;    ///< across the whole ground, with one gap each
  int gap = 9;      ///< [cells] width of the gap
  Cell what = kObstacle;

  Grid draw(std::mt19937_64& random) const {
    Grid grid(cell_size, lower, width, height);
    for (Cell& cell : grid.cells()) cell = kFree;
    for (int i = 0; i < blocks; ++i) {
      const CellIndex corner = somewhere(random);
      const int w = drawn(random, 1, largest);
      const int h = drawn(random, 1, largest);
      for (int y = 0; y < h; ++y)
        for (int x = 0; x < w; ++x) grid.set({corner.x + x, corner.y + y}, what);
    }
    for (int i = 0; i < specks; ++i) grid.set(somewhere(random), what);
    for (int i = 0; i < walls; ++i) {
      const int x = drawn(random, lower.x, lower.x + width - 1);
      const int from = drawn(random, lower.y, lower.y + height - gap);
      for (int y = lower.y; y < lower.y + height; ++y)
        if (y < from || y >= from + gap) grid.set({x, y}, what);
    }
    return grid;
  }
  CellIndex somewhere(std::mt19937_64& random) const {
    return {drawn(random, lower.x, lower.x + width - 1),
            drawn(random, lower.y, lower.y + height - 1)};
  }
  /// A random pose on it.
  Pose2 pose(std::mt19937_64& random) const {
    return {cell_size * (lower.x + width * drawn(random, 0.0, 1.0)),
            cell_size * (lower.y + height * drawn(random, 0.0, 1.0)), drawn(random, -kPi, kPi)};
  }
};

}  // namespace tread::planner::testkit
