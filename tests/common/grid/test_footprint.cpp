// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <array>
#include <cmath>
#include <limits>

#include "common/grid/footprint.hpp"
#include "tests/common/grid/worlds.hpp"

using namespace tread;

namespace {

/// Overlap of two convex shapes along an axis [m]; negative if disjoint.
double overlapAlong(const Eigen::Vector2d& axis, const std::array<Eigen::Vector2d, 4>& a,
                    const std::array<Eigen::Vector2d, 4>& b) {
  const auto extent = [&](const std::array<Eigen::Vector2d, 4>& corners) {
    double low = 1e300;
    double high = -1e300;
    for (const auto& corner : corners) {
      low = std::min(low, axis.dot(corner));
      high = std::max(high, axis.dot(corner));
    }
    return std::make_pair(low, high);
  };
  const auto [a_low, a_high] = extent(a);
  const auto [b_low, b_high] = extent(b);
  return std::min(a_high, b_high) - std::max(a_low, b_low);
}

/// Separating axes: the definition of the overlap of two rectangles [m], positive = overlap.
double overlap(const Footprint& footprint, const Pose2& pose, CellIndex cell, double size) {
  const std::array<Eigen::Vector2d, 4> rectangle{
      pose * Eigen::Vector2d(footprint.size().front, footprint.size().half_width),
      pose * Eigen::Vector2d(-footprint.size().rear, footprint.size().half_width),
      pose * Eigen::Vector2d(-footprint.size().rear, -footprint.size().half_width),
      pose * Eigen::Vector2d(footprint.size().front, -footprint.size().half_width)};
  const double x = cell.x * size;
  const double y = cell.y * size;
  const std::array<Eigen::Vector2d, 4> square{
      Eigen::Vector2d{x, y}, {x + size, y}, {x + size, y + size}, {x, y + size}};
  const Eigen::Vector2d along(std::cos(pose.yaw), std::sin(pose.yaw));
  const std::array<Eigen::Vector2d, 4> axes{Eigen::Vector2d{1.0, 0.0}, Eigen::Vector2d{0.0, 1.0},
                                            along, Eigen::Vector2d{-along.y(), along.x()}};
  double least = 1e300;
  for (const auto& axis : axes) least = std::min(least, overlapAlong(axis, rectangle, square));
  return least;
}

struct Truth {
  int surely = 0;   ///< overlapping cells
  int perhaps = 0;  ///< cells that touch up to rounding
};

/// By definition: checks every surrounding cell.
Truth blockedUnder(const Footprint& footprint, const Pose2& pose, const Grid& grid,
                   bool unknown_blocks) {
  Truth truth;
  const CellIndex at = grid.indexOf(pose.position());
  const int reach = static_cast<int>(footprint.circumscribed() / grid.cellSize()) + 2;
  for (int y = at.y - reach; y <= at.y + reach; ++y)
    for (int x = at.x - reach; x <= at.x + reach; ++x) {
      if (!isBlocked(grid.at({x, y}), unknown_blocks)) continue;
      const double depth = overlap(footprint, pose, {x, y}, grid.cellSize());
      if (depth > 1e-7)
        ++truth.surely;
      else if (depth > -1e-7)
        ++truth.perhaps;
    }
  return truth;
}

}  // namespace

TEST_CASE("a footprint is free exactly where no blocked cell overlaps it") {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> position(-1.5, 5.5);
  std::uniform_real_distribution<double> turn(-7.0, 7.0);
  const std::array<Footprint, 4> footprints{
      Footprint({0.75, 0.75, 0.5}, 0.05), Footprint({0.2, 1.3, 0.2}, 0.0),
      Footprint({0.02, 0.02, 0.6}, 0.0), Footprint({2.0, -0.5, 0.3}, 0.0)};
  Grid grid;
  ClearanceField field;
  int free = 0;
  for (const double density : {0.0, 0.001, 0.01})
    for (int i = 0; i < 2400; ++i) {
      const bool unknown_blocks = i % 200 < 100;
      if (i % 100 == 0) {
        grid = randomGrid(random, {-5, -7}, 51, 49, density, density);
        field = ClearanceField(grid, unknown_blocks);
      }
      const Footprint& footprint = footprints[static_cast<size_t>(i) % footprints.size()];
      const Pose2 pose{position(random), position(random), turn(random)};
      const Truth truth = blockedUnder(footprint, pose, grid, unknown_blocks);
      const bool judged = footprint.isFree(field, turned(pose));
      CAPTURE(pose.x, pose.y, pose.yaw, truth.surely, truth.perhaps, unknown_blocks);
      if (truth.surely > 0) REQUIRE_FALSE(judged);
      if (truth.surely == 0 && truth.perhaps == 0) REQUIRE(judged);
      const int blocked = footprint.blockedCells(grid, pose, unknown_blocks);
      REQUIRE(blocked >= truth.surely);
      REQUIRE(blocked <= truth.surely + truth.perhaps);
      free += judged ? 1 : 0;
    }
  REQUIRE(free > 1000);
  REQUIRE(free < 6000);
}

TEST_CASE("the cells of a footprint are those that it overlaps, whatever its heading") {
  std::mt19937_64 random(4);
  std::uniform_real_distribution<double> draw(-3.0, 3.0);
  const Grid grid(0.1, {0, 0}, 1, 1);
  const Footprint footprint({0.9, 0.4, 0.35}, 0.0);
  for (int i = 0; i < 200; ++i) {
    const Pose2 pose{draw(random), draw(random), draw(random)};
    const auto cells = footprint.cells(grid, pose);
    double area = 0.0;
    for (const CellIndex cell : cells) {
      REQUIRE(overlap(footprint, pose, cell, 0.1) > 0.0);
      area += 0.01;
    }
    REQUIRE(area >= 1.3 * 0.7);
    const Truth truth = blockedUnder(footprint, pose, grid, true);
    REQUIRE(static_cast<int>(cells.size()) >= truth.surely);
  }
}

TEST_CASE("a footprint that lies on the borders of cells touches its neighbours without overlap") {
  Grid grid(0.1, {-20, -20}, 40, 40);
  std::fill(grid.cells().begin(), grid.cells().end(), kObstacle);
  for (int y = -3; y < 3; ++y)
    for (int x = -5; x < 5; ++x) grid.set({x, y}, kFree);
  const ClearanceField field(grid, true);
  const Footprint footprint({0.5, 0.5, 0.3}, 0.0);
  for (const double yaw : {0.0, kPi, -kPi, 2.0 * kPi})
    REQUIRE(footprint.isFree(field, turned({0.0, 0.0, yaw})));
  REQUIRE_FALSE(footprint.isFree(field, turned({0.001, 0.0, 0.0})));
  REQUIRE_FALSE(footprint.isFree(field, turned({0.0, 0.0, 0.01})));
  REQUIRE(footprint.cells(grid, {0.0, 0.0, 0.0}).size() == 60);
}

TEST_CASE("poses that are no poses are not free and cover no cell") {
  const Grid grid(0.1, {0, 0}, 10, 10);
  const ClearanceField field(grid, false);
  const Footprint footprint({0.5, 0.5, 0.3}, 0.0);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const Pose2 bad :
       {Pose2{nan, 0, 0}, Pose2{0, nan, 0}, Pose2{0, 0, nan}, Pose2{1e300, 0, 0}}) {
    REQUIRE_FALSE(footprint.isFree(field, turned(bad)));
    REQUIRE(footprint.cells(grid, bad).empty());
    REQUIRE(footprint.blockedCells(grid, bad, true) == 0);
  }
}

TEST_CASE("a footprint has its margin on all sides and must have an area") {
  const Footprint footprint({0.8, 0.6, 0.5}, 0.1);
  REQUIRE(footprint.size().front == Approx(0.9));
  REQUIRE(footprint.size().rear == Approx(0.7));
  REQUIRE(footprint.size().half_width == Approx(0.6));
  REQUIRE(footprint.circumscribed() == Approx(std::hypot(0.9, 0.6)));
  REQUIRE_THROWS_AS(Footprint({0.5, -0.6, 0.5}, 0.0), std::invalid_argument);
  REQUIRE_THROWS_AS(Footprint({0.5, 0.5, 0.0}, 0.0), std::invalid_argument);
}
