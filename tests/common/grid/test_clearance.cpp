// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

#include "common/grid/clearance.hpp"
#include "tests/common/grid/worlds.hpp"

using namespace tread;

namespace {

/// By definition: checks all blocked cells, with a frame of unknown cells around the window.
double trueClearance(const Grid& grid, bool unknown_blocks, const Eigen::Vector2d& p_map) {
  double nearest = std::numeric_limits<double>::infinity();
  const CellIndex lower = grid.lower();
  for (int y = lower.y - 1; y <= lower.y + grid.height(); ++y)
    for (int x = lower.x - 1; x <= lower.x + grid.width(); ++x)
      if (isBlocked(grid.at({x, y}), unknown_blocks))
        nearest = std::min(nearest, distanceToCell(p_map, {x, y}, grid.cellSize()));
  return nearest;
}

void compareAtCentres(const Grid& grid, bool unknown_blocks) {
  const ClearanceField field(grid, unknown_blocks);
  for (int y = 0; y < grid.height(); ++y)
    for (int x = 0; x < grid.width(); ++x) {
      const Eigen::Vector2d centre = grid.centre({grid.lower().x + x, grid.lower().y + y});
      const double truth = trueClearance(grid, unknown_blocks, centre);
      CAPTURE(x, y, unknown_blocks, truth);
      if (std::isinf(truth)) {
        REQUIRE(std::isinf(field.at(centre)));
      } else {
        REQUIRE(field.at(centre) == Approx(truth).margin(1e-6));
      }
    }
}

}  // namespace

TEST_CASE(
    "at the centres of cells the clearance is the exact distance to the nearest blocked area") {
  std::mt19937_64 random(1);
  for (const double density : {0.0, 0.002, 0.02, 0.3, 1.0})
    for (const bool unknown_blocks : {false, true}) {
      compareAtCentres(randomGrid(random, {-7, 11}, 37, 23, density, density), unknown_blocks);
      compareAtCentres(randomGrid(random, {0, 0}, 1, 19, density, 0.0), unknown_blocks);
      compareAtCentres(randomGrid(random, {0, 0}, 19, 1, density, 0.0), unknown_blocks);
    }
}

TEST_CASE("anywhere the clearance is a lower bound, and the truth lies between the bounds") {
  std::mt19937_64 random(2);
  std::uniform_real_distribution<double> draw(-2.0, 4.5);
  for (const bool unknown_blocks : {false, true}) {
    const Grid grid = randomGrid(random, {-7, 5}, 31, 29, 0.01, 0.01);
    const ClearanceField field(grid, unknown_blocks);
    for (int i = 0; i < 3000; ++i) {
      const Eigen::Vector2d p_map(draw(random), draw(random));
      const bool inside = grid.contains(grid.indexOf(p_map));
      const double truth =
          inside || !unknown_blocks ? trueClearance(grid, unknown_blocks, p_map) : 0.0;
      const auto bounds = field.bounds(p_map);
      CAPTURE(p_map.x(), p_map.y(), truth);
      REQUIRE(bounds.lower <= truth + 1e-9);
      REQUIRE(bounds.upper >= truth - 1e-9);
      REQUIRE(bounds.lower >= 0.0);
      if (inside) REQUIRE(bounds.lower >= truth - 0.1 * std::sqrt(2.0) - 1e-6);
    }
  }
}

TEST_CASE("with a cap the clearance is the same to the bit up to there, however it is worked out") {
  std::mt19937_64 random(3);
  for (const double density : {0.0, 0.002, 0.02, 0.3, 1.0})
    for (const bool unknown_blocks : {false, true})
      for (const double cap : {0.0, 0.01, 0.33, 0.4, 0.8, 1.55, 3.2, 3.3}) {
        const Grid cells = randomGrid(random, {-7, 11}, 57, 43, density, 0.01);
        // For some cell sizes the cap is a number of half cells that a float rounds down.
        Grid grid(std::vector<double>{0.1, 0.04, 0.06, 0.08}[random() % 4], {-7, 11}, 57, 43);
        grid.cells() = cells.cells();
        const ClearanceField whole(grid, unknown_blocks);
        const ClearanceField capped(grid, unknown_blocks, cap);
        CAPTURE(density, unknown_blocks, cap);
        for (int y = 0; y < grid.height(); ++y)
          for (int x = 0; x < grid.width(); ++x)
            REQUIRE(capped.row(y)[x] == std::min(whole.row(y)[x], static_cast<float>(cap)));
      }
}

TEST_CASE("blocked cells have no clearance anywhere in them") {
  Grid grid(0.1, {0, 0}, 20, 20);
  std::fill(grid.cells().begin(), grid.cells().end(), kFree);
  grid.set({10, 10}, kObstacle);
  const ClearanceField field(grid, false);
  for (double x = 1.001; x < 1.1; x += 0.01) REQUIRE(field.at({x, 1.099}) == 0.0);
  REQUIRE(field.at({0.95, 1.05}) == Approx(0.05).margin(1e-6));
}

TEST_CASE(
    "outside the window the clearance is zero if unknown blocks, else that of its nearest point") {
  Grid grid(0.1, {0, 0}, 20, 20);
  std::fill(grid.cells().begin(), grid.cells().end(), kFree);
  grid.set({10, 10}, kObstacle);
  REQUIRE(ClearanceField(grid, true).at({3.0, 1.0}) == 0.0);
  REQUIRE(ClearanceField(grid, false).at({3.0, 1.05}) == Approx(0.85).margin(1e-6));
}

TEST_CASE("without anything that blocks the clearance is infinite, and for NaN it is zero") {
  const Grid grid(0.1, {0, 0}, 20, 20);
  const ClearanceField field(grid, false);
  REQUIRE(std::isinf(field.at({1.0, 1.0})));
  const double nan = std::numeric_limits<double>::quiet_NaN();
  REQUIRE(field.at({nan, 1.0}) == 0.0);
  REQUIRE(ClearanceField().at({0.0, 0.0}) == 0.0);
}
