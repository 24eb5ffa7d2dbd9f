// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <queue>

#include "modules/planner/core/map/clearance_map.hpp"
#include "modules/planner/core/map/distance_to_goal.hpp"
#include "tests/planner/kit/playground.hpp"
#include "tests/planner/kit/vehicle.hpp"

using namespace tread;
using namespace tread::planner;
using namespace tread::planner::testkit;

namespace {

constexpr double kCell = 0.1;
constexpr int kTileCells = 32;

DistanceFieldConfig plain() {
  DistanceFieldConfig config = usualField();
  config.tight_weight = 0.0;
  config.reach = 100.0;
  return config;
}

ClearanceMap mapOf(const Grid& grid) {
  ClearanceMap map(kCell, kTileCells, ClearanceMapConfig{});
  for (const Tile& tile : tilesOf(grid, kTileCells, 1)) map.put(tile);
  map.refresh();
  return map;
}

/// Shortest path of a point that keeps a distance from obstacles, over the fine cells and 16
/// directions: an upper bound, at most 3 % too long.
std::vector<double> waysTo(const Grid& grid, const ClearanceField& room, double radius,
                           CellIndex goal) {
  std::vector<double> way(grid.cells().size(), std::numeric_limits<double>::infinity());
  using Entry = std::pair<double, size_t>;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open;
  way[grid.offset(goal)] = 0.0;
  open.push({0.0, grid.offset(goal)});
  const auto passable = [&](CellIndex cell) {
    return grid.contains(cell) && room.at(grid.centre(cell)) >= radius;
  };
  while (!open.empty()) {
    const auto [length, offset] = open.top();
    open.pop();
    if (length > way[offset]) continue;
    const CellIndex at{grid.lower().x + static_cast<int>(offset) % grid.width(),
                       grid.lower().y + static_cast<int>(offset) / grid.width()};
    for (int dy = -2; dy <= 2; ++dy) {
      for (int dx = -2; dx <= 2; ++dx) {
        const CellIndex next{at.x + dx, at.y + dy};
        const CellIndex half{at.x + dx / 2, at.y + dy / 2};
        const CellIndex other{next.x - dx / 2, next.y - dy / 2};
        if (!passable(next) || !passable(half) || !passable(other)) continue;
        const double longer = length + kCell * std::hypot(dx, dy);
        if (longer >= way[grid.offset(next)]) continue;
        way[grid.offset(next)] = longer;
        open.push({longer, grid.offset(next)});
      }
    }
  }
  return way;
}

}  // namespace

TEST_CASE(
    "The distance to the goal is a lower bound of the true shortest way, and not a loose one") {
  for (const uint64_t seed : {3U, 11U, 27U}) {
    const Mission mission = randomMission(seed);
    const Grid grid = mission.ground.paint(kCell, {-6.4, -12.8}, {38.4, 12.8});
    const ClearanceMap map = mapOf(grid);
    Goal goal = mission.goal;
    goal.position_tolerance = 0.05;
    const DistanceToGoal field(map, goal, {0.0, 0.0}, {}, plain());
    const ClearanceField room(grid, false);
    const std::vector<double> ways =
        waysTo(grid, room, 0.36, grid.indexOf(goal.T_map_goal.position()));
    double loosest = 1.0;
    for (size_t i = 0; i < ways.size(); i += 37) {
      if (!std::isfinite(ways[i]) || ways[i] < 2.0) continue;
      const CellIndex cell{grid.lower().x + static_cast<int>(i) % grid.width(),
                           grid.lower().y + static_cast<int>(i) / grid.width()};
      const double bound =
          DistanceToGoal::kAdmissibleShare * field.length(grid.centre(cell)) - 0.15;
      REQUIRE(bound <= ways[i]);
      loosest = std::min(loosest, (bound + 0.15) / ways[i]);
    }
    CHECK(loosest > 0.75);
  }
}

TEST_CASE("The way leads around a wall, and follows it down to the goal") {
  Playground ground;
  ground.addWall({5.0, -4.0}, {5.0, 4.0});
  const ClearanceMap map = mapOf(ground.paint(kCell, {-6.4, -9.6}, {16.0, 9.6}));
  const Goal goal{1, {10.0, 0.0, 0.0}, 0.3, 4.0};
  const DistanceToGoal field(map, goal, {0.0, 0.0}, {}, plain());
  const double around = 2.0 * std::hypot(5.0, 4.3);
  CHECK(field.length({0.0, 0.0}) == Approx(around).epsilon(0.08));
  const auto points = field.descend({0.0, 0.0}, 0.1, 300);
  REQUIRE(!points.empty());
  CHECK((points.back() - goal.T_map_goal.position()).norm() < 0.6);
  for (const auto& p : points) CHECK(!ground.isObstacle(p));
}

TEST_CASE("An enclosed goal is unreachable at once, so is one on obstacles and one far away") {
  Playground ground;
  ground.addWall({8.0, -2.0}, {12.0, -2.0});
  ground.addWall({12.0, -2.0}, {12.0, 2.0});
  ground.addWall({12.0, 2.0}, {8.0, 2.0});
  ground.addWall({8.0, 2.0}, {8.0, -2.0});
  ground.add({{20.0, 0.0, 0.0}, 1.5, 1.5});
  const ClearanceMap map = mapOf(ground.paint(kCell, {-6.4, -9.6}, {25.6, 9.6}));
  const DistanceToGoal enclosed(map, {1, {10.0, 0.0, 0.0}, 0.3, 4.0}, {0.0, 0.0}, {}, plain());
  CHECK(enclosed.unreachable());
  CHECK(enclosed.problem() == "obstacles enclose the goal or the vehicle");
  CHECK(std::isinf(enclosed.length({0.0, 0.0})));
  // The box around the goal is small: few cells need to be visited.
  CHECK(enclosed.filled() < 500);
  const DistanceToGoal blocked(map, {1, {20.0, 0.0, 0.0}, 0.3, 4.0}, {0.0, 0.0}, {}, plain());
  CHECK(blocked.unreachable());
  CHECK(blocked.problem() == "the goal lies on obstacles");
  const DistanceToGoal far(map, {1, {1e5, 0.0, 0.0}, 0.3, 4.0}, {0.0, 0.0}, {}, plain());
  CHECK(far.problem().find("the goal is farther away than 150 m") == 0);
  CHECK(std::isinf(far.length({0.0, 0.0})));
}

TEST_CASE("Unknown ground may be free: the way leads through it, and tells where it begins") {
  Playground ground;
  ClearanceMap map = mapOf(ground.paint(kCell, {-6.4, -6.4}, {6.4, 6.4}));
  const DistanceToGoal field(map, {1, {15.0, 0.0, 0.0}, 0.3, 4.0}, {0.0, 0.0}, {}, plain());
  CHECK(field.length({0.0, 0.0}) == Approx(14.8).margin(0.4));
  CHECK(field.untilUnknown({2.0, 0.0}) == Approx(4.4).margin(0.4));
  CHECK(field.untilUnknown({8.0, 0.0}) == 0.0);
}

TEST_CASE("A detour makes a place longer but never impassable") {
  Playground ground;
  ground.addWall({5.0, -9.0}, {5.0, -0.8});
  ground.addWall({5.0, 0.8}, {5.0, 6.0});
  const ClearanceMap map = mapOf(ground.paint(kCell, {-6.4, -9.6}, {16.0, 9.6}));
  const Goal goal{1, {10.0, 0.0, 0.0}, 0.3, 4.0};
  const DistanceToGoal direct(map, goal, {0.0, 0.0}, {}, plain());
  const DistanceToGoal detour(map, goal, {0.0, 0.0}, {{{5.0, 0.0}, 1.0}}, plain());
  CHECK(direct.length({0.0, 0.0}) < 10.5);
  CHECK(detour.length({0.0, 0.0}) > 14.0);
  CHECK(!detour.unreachable());
}

TEST_CASE("What mapping has forgotten stays known: a dead end is not forgotten") {
  Playground ground;
  ground.addWall({5.0, -4.0}, {5.0, 4.0});
  ClearanceMap map = mapOf(ground.paint(kCell, {-6.4, -9.6}, {16.0, 9.6}));
  for (Tile tile : tilesOf(Grid(kCell, {-64, -96}, 224, 192), kTileCells, 2)) map.put(tile);
  map.refresh();
  const DistanceToGoal field(map, {1, {10.0, 0.0, 0.0}, 0.3, 4.0}, {0.0, 0.0}, {}, plain());
  CHECK(field.length({0.0, 0.0}) > 12.0);
}

TEST_CASE("A way that is interrupted is known near the goal, and nowhere longer than in full") {
  Playground ground;
  ground.addWall({5.0, -4.0}, {5.0, 4.0});
  const ClearanceMap map = mapOf(ground.paint(kCell, {-6.4, -9.6}, {16.0, 9.6}));
  const Goal goal{1, {10.0, 0.0, 0.0}, 0.3, 4.0};
  const DistanceToGoal full(map, goal, {0.0, 0.0}, {}, plain());
  for (const int most : {1, 5, 30, 70}) {
    int asked = 0;
    DistanceToGoal part;
    part.compute(map, goal, {0.0, 0.0}, {}, plain(), [&] { return ++asked >= most; });
    CHECK(asked == most);
    CHECK_FALSE(part.unreachable());
    CHECK(part.filled() < full.filled());
    for (double x = -6.0; x < 15.0; x += 0.7)
      for (double y = -9.0; y < 9.0; y += 0.7) {
        const Eigen::Vector2d p(x, y);
        if (std::isfinite(full.length(p))) CHECK(part.length(p) <= full.length(p) + 0.3);
      }
    if (most > 20) CHECK(part.length({9.0, 0.0}) == full.length({9.0, 0.0}));
  }
}

TEST_CASE("Changes that concern nobody's way do not count as changes of the passages") {
  Playground ground;
  ground.add({{3.0, 3.0, 0.0}, 1.0, 1.0});
  const Grid grid = ground.paint(kCell, {-6.4, -6.4}, {6.4, 6.4});
  ClearanceMap map = mapOf(grid);
  const int64_t revision = map.clearanceRevision();
  for (Tile tile : tilesOf(grid, kTileCells, 2)) map.put(tile);
  map.refresh();
  CHECK(map.clearanceRevision() == revision);
  Grid changed = grid;
  changed.set(changed.indexOf({-3.0, -3.0}), kObstacle);
  for (Tile tile : tilesOf(changed, kTileCells, 3)) map.put(tile);
  map.refresh();
  CHECK(map.clearanceRevision() > revision);
}

TEST_CASE("The ground that the vehicle stands on becomes free only where it was unknown") {
  ClearanceMap map(kCell, kTileCells, ClearanceMapConfig{});
  Tile tile{0, 0, 5, std::vector<Cell>(kTileCells * kTileCells, kUnknown)};
  tile.cells[0] = kObstacle;
  map.put(tile);
  map.assumeFree({{0, 0}, {1, 0}, {-1, -1}});
  const Grid window = map.window({-2, -2}, 5, 5);
  CHECK(window.at({0, 0}) == kObstacle);
  CHECK(window.at({1, 0}) == kFree);
  CHECK(window.at({-1, -1}) == kFree);
  CHECK(window.at({2, 0}) == kUnknown);
}
