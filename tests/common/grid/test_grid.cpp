// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <limits>

#include "common/grid/grid.hpp"

using namespace tread;

TEST_CASE("a new grid is unknown everywhere, inside and outside its window") {
  const Grid grid(0.1, {-3, -2}, 5, 4);
  REQUIRE(grid.cells().size() == 20);
  for (const Cell cell : grid.cells()) REQUIRE(cell == kUnknown);
  REQUIRE(grid.at({100, 100}) == kUnknown);
  REQUIRE(Grid().empty());
}

TEST_CASE("cells are set inside the window only and keep their index in map") {
  Grid grid(0.5, {-3, -2}, 5, 4);
  grid.set({-3, -2}, kFree);
  grid.set({1, 1}, kObstacle);
  grid.set({2, 1}, kObstacle);
  REQUIRE(grid.at({-3, -2}) == kFree);
  REQUIRE(grid.cells().front() == kFree);
  REQUIRE(grid.cells().back() == kObstacle);
  REQUIRE(grid.at({2, 1}) == kUnknown);
}

TEST_CASE(
    "a point belongs to the cell whose centre is nearest, also left and below of the origin") {
  const Grid grid(0.1, {-100, -100}, 200, 200);
  for (double x = -9.97; x < 9.97; x += 0.0931)
    for (double y = -9.97; y < 9.97; y += 0.1173) {
      const Eigen::Vector2d to_centre = grid.centre(grid.indexOf({x, y})) - Eigen::Vector2d(x, y);
      REQUIRE(to_centre.cwiseAbs().maxCoeff() <= 0.05 + 1e-12);
    }
  REQUIRE(grid.indexOf({-0.01, 0.01}) == CellIndex{-1, 0});
}

TEST_CASE("points that are no points lie in no cell of any window") {
  const Grid grid(0.1, {-100, -100}, 200, 200);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  const double infinity = std::numeric_limits<double>::infinity();
  for (const double bad : {nan, infinity, -infinity, 1e300}) {
    REQUIRE_FALSE(grid.contains(grid.indexOf({bad, 0.0})));
    REQUIRE_FALSE(grid.contains(grid.indexOf({0.0, bad})));
  }
}

TEST_CASE("free cells never block, obstacles always, unknown cells where asked") {
  REQUIRE_FALSE(isBlocked(kFree, true));
  REQUIRE_FALSE(isBlocked(kCostMax, true));
  REQUIRE(isBlocked(kObstacle, false));
  REQUIRE(isBlocked(kUnknown, true));
  REQUIRE_FALSE(isBlocked(kUnknown, false));
  REQUIRE(isBlocked(200, false));
}
