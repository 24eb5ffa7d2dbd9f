// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <algorithm>
#include <cmath>
#include <map>
#include <random>
#include <set>

#include "modules/planner/core/map/clearance_map.hpp"
#include "tests/helpers.hpp"
#include "tests/planner/kit/random_ground.hpp"

using namespace tread;
using namespace tread::planner;
using namespace tread::planner::testkit;

namespace {

using Coarse = std::pair<int, int>;

Coarse coarseOf(CellIndex cell, int coarse) {
  return {static_cast<int>(std::floor(static_cast<double>(cell.x) / coarse)),
          static_cast<int>(std::floor(static_cast<double>(cell.y) / coarse))};
}

/// Slow reference that computes everything again, in maps without windows.
struct Reference {
  Reference(const Grid& grid, const ClearanceField& field, int coarse, double radius) {
    for (int y = grid.lower().y; y < grid.lower().y + grid.height(); ++y) {
      for (int x = grid.lower().x; x < grid.lower().x + grid.width(); ++x) {
        const Coarse at = coarseOf({x, y}, coarse);
        clearance[at] = std::max(clearance[at], field.at(grid.centre({x, y})));
        unknown[at] += grid.at({x, y}) == kUnknown ? 1 : 0;
      }
    }
    int number = 0;
    for (const auto& [at, free] : clearance)
      if (isOpen(at, radius) && area[at] == 0) flood(at, radius, ++number);
  }
  bool isOpen(Coarse at, double radius) const {
    const auto found = clearance.find(at);
    return found != clearance.end() && found->second > 0.0 && found->second >= radius - 1e-6;
  }
  void flood(Coarse from, double radius, int number) {
    std::vector<Coarse> open{from};
    while (!open.empty()) {
      const Coarse at = open.back();
      open.pop_back();
      if (!isOpen(at, radius) || area[at] != 0) continue;
      area[at] = number;
      for (const int dx : {-1, 0, 1})
        for (const int dy : {-1, 0, 1}) open.push_back({at.first + dx, at.second + dy});
    }
  }

  std::map<Coarse, double> clearance;
  std::map<Coarse, int> unknown;
  std::map<Coarse, int> area;
};

RandomGround smallGround(std::mt19937_64& random) {
  RandomGround ground;
  ground.lower = {drawn(random, -120, 60), drawn(random, -120, 60)};
  ground.width = drawn(random, 1, 70);
  ground.height = drawn(random, 1, 70);
  ground.walls = ground.width > 20 && ground.height > 20 ? 3 : 0;
  ground.what = drawn(random, 0, 3) == 0 ? kUnknown : kObstacle;
  return ground;
}

Eigen::Vector2d centreOf(Coarse at, double size) {
  return {(at.first + 0.5) * size, (at.second + 0.5) * size};
}

/// A map, its passages and the expected ones.
struct Bench {
  explicit Bench(std::mt19937_64& random)
      : ground(smallGround(random)),
        grid(ground.draw(random)),
        field(grid, drawn(random, 0, 1) == 0),
        coarse(drawn(random, 1, 4)),
        // Between the possible distances, so that rounding has no influence.
        radius(0.05 * drawn(random, 0, 7) + 0.012),
        passages(grid, field, coarse),
        reference(grid, field, coarse, radius) {
    passages.label(radius);
  }
  double size() const { return coarse * grid.cellSize(); }

  RandomGround ground;
  Grid grid;
  ClearanceField field;
  int coarse;
  double radius;
  CoarseClearance passages;
  Reference reference;
};

}  // namespace

TEST_CASE("areas are those of a plain flood fill, wherever the map lies") {
  std::mt19937_64 random(1);
  std::set<int> counts;
  for (int i = 0; i < testing::effort(150); ++i) {
    const Bench bench(random);
    std::map<int, int> to_reference;
    std::map<int, int> from_reference;
    for (const auto& entry : bench.reference.clearance) {
      const Coarse at = entry.first;
      const int area = bench.passages.areaAt(centreOf(at, bench.size()));
      const auto found = bench.reference.area.find(at);
      const int expected = found == bench.reference.area.end() ? 0 : found->second;
      REQUIRE((area == 0) == (expected == 0));
      REQUIRE(to_reference.emplace(area, expected).first->second == expected);
      REQUIRE(from_reference.emplace(expected, area).first->second == area);
    }
    counts.insert(static_cast<int>(to_reference.size()));
  }
  CHECK(counts.size() >= 3);
}

TEST_CASE("a window has the room and the unknown of its cells, none of the first outside") {
  std::mt19937_64 random(2);
  for (int i = 0; i < testing::effort(100); ++i) {
    const Bench bench(random);
    ClearanceWindow window = *bench.passages.bounds();
    REQUIRE(static_cast<size_t>(window.width * window.height) == bench.reference.clearance.size());
    window.lower_x -= 2;
    window.lower_y -= 1;
    window.width += 3;
    window.height += 4;
    const auto count = static_cast<size_t>(window.width * window.height);
    window.clearance.assign(count, -1.0F);
    window.unknown.assign(count, 7);
    bench.passages.fill(window);
    for (int y = window.lower_y; y < window.lower_y + window.height; ++y) {
      for (int x = window.lower_x; x < window.lower_x + window.width; ++x) {
        const auto found = bench.reference.clearance.find({x, y});
        const float room = window.clearance[window.at(x, y)];
        const int unknown = window.unknown[window.at(x, y)];
        if (found == bench.reference.clearance.end()) {
          REQUIRE(room == 0.0F);
          REQUIRE(unknown == 1);
          continue;
        }
        if (std::isfinite(found->second))
          REQUIRE(static_cast<double>(room) == Approx(found->second).margin(1e-5));
        else
          REQUIRE(std::isinf(room));
        const int half = (bench.coarse * bench.coarse + 1) / 2;
        REQUIRE(unknown == (bench.reference.unknown.at({x, y}) >= half ? 1 : 0));
      }
    }
  }
}

TEST_CASE("no area within a distance of a point is left out, and none far beyond it is named") {
  std::mt19937_64 random(3);
  for (int i = 0; i < testing::effort(150); ++i) {
    const Bench bench(random);
    const Eigen::Vector2d p = bench.ground.pose(random).position();
    const double distance = drawn(random, 0.0, 1.5);
    const std::vector<int> areas = bench.passages.areasNear(p, distance);
    const auto named = [&areas](int area) {
      return std::find(areas.begin(), areas.end(), area) != areas.end();
    };
    for (int k = 0; k < 200; ++k) {
      const double angle = drawn(random, -kPi, kPi);
      const double reach = distance * drawn(random, 0.0, 1.0);
      const int area =
          bench.passages.areaAt(p + reach * Eigen::Vector2d(std::cos(angle), std::sin(angle)));
      if (area != 0) REQUIRE(named(area));
    }
    std::map<int, double> nearest;
    for (const auto& entry : bench.reference.area) {
      const Eigen::Vector2d centre = centreOf(entry.first, bench.size());
      const int area = bench.passages.areaAt(centre);
      const double off = (centre - p).norm();
      if (area != 0) nearest[area] = std::min(nearest.emplace(area, off).first->second, off);
    }
    for (const int area : areas) REQUIRE(nearest.at(area) <= distance + 0.72 * bench.size());
    REQUIRE(std::set<int>(areas.begin(), areas.end()).size() == areas.size());
  }
}

TEST_CASE("the nearest cell of some areas is the nearest there is") {
  std::mt19937_64 random(4);
  for (int i = 0; i < testing::effort(150); ++i) {
    const Bench bench(random);
    const Eigen::Vector2d p = bench.ground.pose(random).position() + Eigen::Vector2d(3.0, -2.0);
    const std::vector<int> wanted{drawn(random, 1, 3), drawn(random, 1, 3)};
    double least = std::numeric_limits<double>::infinity();
    for (const auto& entry : bench.reference.area) {
      const Eigen::Vector2d centre = centreOf(entry.first, bench.size());
      const int area = bench.passages.areaAt(centre);
      if (std::find(wanted.begin(), wanted.end(), area) != wanted.end() && area != 0)
        least = std::min(least, (centre - p).norm());
    }
    const std::optional<Eigen::Vector2d> nearest = bench.passages.nearestIn(wanted, p);
    REQUIRE(nearest.has_value() == std::isfinite(least));
    if (nearest) REQUIRE((*nearest - p).norm() == Approx(least));
  }
}

TEST_CASE("where a disc can go from cell to cell, one area reaches") {
  std::mt19937_64 random(5);
  for (int i = 0; i < testing::effort(60); ++i) {
    const Bench bench(random);
    // Two free neighbours are in the same area; otherwise the map would be divided there.
    for (int y = bench.grid.lower().y; y < bench.grid.lower().y + bench.grid.height(); ++y) {
      for (int x = bench.grid.lower().x; x < bench.grid.lower().x + bench.grid.width() - 1; ++x) {
        const Eigen::Vector2d here = bench.grid.centre({x, y});
        const Eigen::Vector2d there = bench.grid.centre({x + 1, y});
        if (bench.field.at(here) < bench.radius || bench.field.at(there) < bench.radius) continue;
        REQUIRE(bench.passages.areaAt(here) != 0);
        REQUIRE(bench.passages.areaAt(here) == bench.passages.areaAt(there));
      }
    }
  }
}

TEST_CASE("an empty map has no areas, a single free cell is one where nothing outside blocks") {
  const Grid none;
  CoarseClearance empty(none, ClearanceField(none, true), 3);
  empty.label(0.1);
  CHECK(empty.areaAt({0.0, 0.0}) == 0);
  CHECK(empty.areasNear({0.0, 0.0}, 10.0).empty());
  CHECK_FALSE(empty.nearestIn({1}, {0.0, 0.0}));
  CHECK(empty.bounds()->width == 0);
  CHECK(empty.bounds()->height == 0);

  Grid one(0.1, {-7, 4}, 1, 1);
  one.set({-7, 4}, kFree);
  CoarseClearance open(one, ClearanceField(one, false), 2);
  open.label(5.0);
  CHECK(open.areaAt({-0.65, 0.45}) == 1);
  CHECK(open.areaAt({-0.45, 0.45}) == 0);
  CoarseClearance closed(one, ClearanceField(one, true), 2);
  closed.label(0.01);
  CHECK(closed.areaAt({-0.65, 0.45}) == 1);
  closed.label(0.06);
  CHECK(closed.areaAt({-0.65, 0.45}) == 0);
}

TEST_CASE("a point that is none, or endlessly far, lies in no area") {
  Grid grid(0.1, {0, 0}, 20, 20);
  for (Cell& cell : grid.cells()) cell = kFree;
  CoarseClearance passages(grid, ClearanceField(grid, false), 2);
  passages.label(0.1);
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {nan, 1e300, -1e300, std::numeric_limits<double>::infinity()}) {
    CHECK(passages.areaAt({bad, 0.5}) == 0);
    CHECK(passages.areasNear({bad, 0.5}, 0.3).empty());
    CHECK(passages.areasNear({0.5, bad}, 0.3).empty());
  }
  CHECK(passages.areasNear({0.5, 0.5}, std::numeric_limits<double>::infinity()).size() == 1);
}
