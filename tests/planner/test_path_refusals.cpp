// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>

#include "tests/helpers.hpp"
#include "tests/planner/kit/path_bench.hpp"
#include "tests/planner/kit/vehicle.hpp"

using namespace tread;
using namespace tread::planner;
using namespace tread::planner::testkit;

namespace {

/// Whether a disc can move from cell to cell, by a plain flood fill.
bool connected(const Grid& grid, const ClearanceField& field, const PathQuery& query,
               double radius) {
  std::vector<uint8_t> seen(grid.cells().size(), 0);
  std::vector<CellIndex> open{grid.indexOf(query.T_map_start.position())};
  while (!open.empty()) {
    const CellIndex cell = open.back();
    open.pop_back();
    if (!grid.contains(cell) || seen[grid.offset(cell)] != 0) continue;
    const Eigen::Vector2d p = grid.centre(cell);
    if (field.at(p) < radius) continue;
    seen[grid.offset(cell)] = 1;
    if ((p - query.T_map_goal.position()).norm() <= query.position_tolerance) return true;
    for (const CellIndex step : {CellIndex{1, 0}, {-1, 0}, {0, 1}, {0, -1}})
      open.push_back({cell.x + step.x, cell.y + step.y});
  }
  return false;
}

/// Whether any pattern that begins at rest is free from the start, pose by pose.
bool anyBegins(const PathBench& bench, const Pose2& start) {
  const FootprintSize size = kVehicle;
  const Footprint exact(size, 0.0);
  for (const TablePattern* pattern : bench.table->from(bench.table->restClass())) {
    bool hit = false;
    for (const SweptPose& at : pattern->swept_poses)
      hit = hit || exact.blockedCells(bench.grid, start * at.pose, bench.config.unknown_blocks) > 0;
    if (!hit) return true;
  }
  return false;
}

/// An open ground of 8 m by 6 m around the origin, for building walls.
struct Room {
  Room() {
    for (Cell& cell : grid.cells()) cell = kFree;
  }
  void block(CellIndex from, CellIndex to) {
    for (int y = from.y; y <= to.y; ++y)
      for (int x = from.x; x <= to.x; ++x) grid.set({x, y}, kObstacle);
  }
  PathAnswer answer(const Pose2& start, const Pose2& goal, double tolerance = 0.25) {
    const PathQuery query{start, goal, tolerance, 4.0};
    return PathPlanner(grid, table, config).answer(query, after(20'000));
  }

  Grid grid{0.1, {-40, -30}, 80, 60};
  PatternTable table{samplePatterns(), usualSweep(), {}};
  PathConfig config = usualPaths();
};

}  // namespace

TEST_CASE("unreachable is only what a plain flood fill of the inscribed disc finds apart as well") {
  int apart = 0;
  int refused = 0;
  int solved = 0;
  for (int i = 0; i < testing::effort(100); ++i) {
    PathBench bench(static_cast<uint64_t>(5000 + i), i % 2 == 0);
    const ClearanceField field(bench.grid, bench.config.unknown_blocks);
    for (int k = 0; k < 6; ++k) {
      const PathQuery query = bench.query();
      const PathAnswer answer = bench.answer(query, 60);
      const bool joined = connected(bench.grid, field, query, kVehicle.half_width);
      INFO("seed " << 5000 + i << " query " << k << ": " << answer.reason);
      apart += joined ? 0 : 1;
      if (answer.end == PathEnd::kSolved) ++solved;
      if (answer.end != PathEnd::kUnreachable) continue;
      ++refused;
      CHECK(answer.search.expansions == 0);  // reported at once
      if (answer.reason.find("no legal successor") == std::string::npos)
        CHECK_FALSE(joined);
      else
        CHECK_FALSE(anyBegins(bench, query.T_map_start));
    }
  }
  CHECK(solved > testing::effort(120));
  CHECK(refused > testing::effort(15));
  CHECK(apart >= refused / 2);
}

TEST_CASE("each refusal says why, and where the vehicle could stand nearest to the goal") {
  Room room;
  room.block({5, -30}, {6, 29});
  room.block({-35, 15}, {-20, 29});
  const Pose2 start{-1.5, 0.0, 0.0};
  const PathAnswer outside = room.answer({-9.0, 0.0, 0.0}, start);
  CHECK(outside.end == PathEnd::kUnreachable);
  CHECK(outside.reason == "the start lies outside the map");
  const PathAnswer far = room.answer(start, {50.0, 0.0, 0.0});
  CHECK(far.end == PathEnd::kUnreachable);
  CHECK(far.reason == "the goal lies outside the map");
  const PathAnswer blocked = room.answer(start, {-2.8, 2.2, 0.0});
  CHECK(blocked.reason == "the goal lies on obstacles, or too near to them");
  const PathAnswer shut = room.answer(start, {2.5, 0.0, 0.0});
  CHECK(shut.end == PathEnd::kUnreachable);
  CHECK(shut.reason == "obstacles enclose the goal or the vehicle");
  REQUIRE(shut.closest);
  CHECK(shut.closest->x() < 0.5);
  CHECK(shut.closest->x() > 0.0);
  CHECK(std::abs(shut.closest->y()) < 0.2);
  CHECK(shut.search.steps.empty());
  CHECK(room.answer(start, {-1.5, -1.0, 1.0}).end == PathEnd::kSolved);
}

TEST_CASE("a start on obstacles is left if so many patterns as may overlap them lead off") {
  Room room;
  room.block({-40, -30}, {-10, 29});
  // 15 cm, and more than the complete vehicle.
  for (const double x : {-0.4, -2.0, -3.0}) {
    const Pose2 start{x, 0.0, 0.0};
    const PathAnswer answer = room.answer(start, {2.0, 0.0, 0.0});
    INFO("from x = " << x << ": " << answer.reason);
    REQUIRE(answer.end == PathEnd::kSolved);
    const FootprintSize size = kVehicle;
    const Footprint footprint(size, 0.0);
    const auto blocked = [&](const Pose2& pose) {
      return footprint.blockedCells(room.grid, pose, true);
    };
    int overlapping = 0;
    for (const PlanStep& step : answer.search.steps) {
      CHECK(blocked(step.T_map_end) <= blocked(start));
      if (blocked(step.T_map_end) > 0) ++overlapping;
    }
    CHECK(overlapping < room.config.search.escape_patterns);
    CHECK(blocked(answer.search.steps.back().T_map_end) == 0);
  }
}

TEST_CASE("a start so deep in obstacles that they may not be left is told so") {
  Room room;
  room.block({-40, -30}, {19, 29});
  const PathAnswer deep = room.answer({-3.0, 0.0, 0.0}, {3.0, 0.0, 0.0});
  CHECK(deep.end == PathEnd::kUnreachable);
  CHECK(deep.reason == "the start lies on obstacles");
  CHECK(room.answer({0.0, 0.0, 0.0}, {3.0, 0.0, 0.0}).end == PathEnd::kSolved);
  room.config.search.escape_patterns = 0;
  CHECK(room.answer({1.5, 0.0, 0.0}, {3.0, 0.0, 0.0}).end == PathEnd::kUnreachable);
}

TEST_CASE("a start that no pattern may leave because it would deepen the overlap is told so") {
  // One obstacle under the vehicle, and only obstacles around it.
  Room room;
  room.block({-40, -30}, {39, 29});
  const Pose2 start{0.0, 0.0, 0.0};
  for (int y = -4; y <= 3; ++y)
    for (int x = -7; x <= 6; ++x) room.grid.set({x, y}, kFree);
  room.grid.set({0, 3}, kObstacle);
  for (int y = 20; y < 29; ++y)
    for (int x = -30; x < 30; ++x) room.grid.set({x, y}, kFree);
  const PathAnswer answer = room.answer(start, {0.0, 2.5, 0.0}, 0.25);
  CHECK(answer.end == PathEnd::kUnreachable);
  CHECK(answer.reason.find("no legal successor") != std::string::npos);
}

TEST_CASE("a start that no pattern may leave is told so") {
  // A slot as wide as the vehicle, closed ahead: it can only reverse out of it.
  Room room;
  PatternSetContent content = samplePatterns().content();
  for (size_t i = content.patterns.size(); i-- > 0;)
    if (content.patterns[i].name == "back")
      content.patterns.erase(content.patterns.begin() + long(i));
  std::string why;
  const PatternTable forward(*PatternSet::make(std::move(content), why), usualSweep(), {});
  room.block({-40, 4}, {7, 29});
  room.block({-40, -30}, {7, -5});
  room.block({7, -4}, {7, 3});
  PathQuery query;
  query.T_map_start = {0.0, 0.0, 0.0};
  query.T_map_goal = {-2.0, 0.0, 0.0};
  const PathAnswer answer =
      PathPlanner(room.grid, forward, room.config).answer(query, after(20'000));
  CHECK(answer.end == PathEnd::kUnreachable);
  CHECK(answer.reason ==
        "the start has no legal successor: each pattern would leave the map or hit something");
  CHECK(room.answer(query.T_map_start, query.T_map_goal).end == PathEnd::kSolved);
}

TEST_CASE("what a coarse search has not found, though it saw all it could, is not unreachable") {
  Room rough;
  rough.config.search.cell = 2.0;
  rough.config.search.heading_bins = 4;
  Room fine;
  const Pose2 start{-3.0, -2.0, 0.0};
  int differs = 0;
  for (double x = -3.0; x <= 3.0; x += 0.5) {
    for (const double y : {-1.0, 0.5, 2.0}) {
      const PathAnswer answer = rough.answer(start, {x, y, 0.0}, 0.1);
      if (answer.end == PathEnd::kSolved) continue;
      REQUIRE(answer.search.exhausted);
      CHECK(answer.end == PathEnd::kNoneInTime);
      CHECK(answer.reason.find("at this resolution") != std::string::npos);
      differs += fine.answer(start, {x, y, 0.0}, 0.1).end == PathEnd::kSolved ? 1 : 0;
    }
  }
  CHECK(differs >= 3);
}

TEST_CASE("a goal that may be anywhere is met at once, however far its tolerance reaches") {
  Room room;
  const Pose2 start{-1.5, 0.0, 0.0};
  for (const double tolerance : {100.0, 1e12, 1e300, std::numeric_limits<double>::infinity()}) {
    CAPTURE(tolerance);
    CHECK(room.answer(start, {2.5, 0.0, 0.0}, tolerance).end == PathEnd::kSolved);
  }
  CHECK(room.answer(start, {1e300, 0.0, 0.0}, 1e300).reason == "the goal lies outside the map");
}

TEST_CASE("goals that are no numbers are refused") {
  Room room;
  const double nan = std::numeric_limits<double>::quiet_NaN();
  for (const double bad : {nan, std::numeric_limits<double>::infinity(), 1e300}) {
    CHECK(room.answer({0.0, 0.0, 0.0}, {bad, 0.0, 0.0}).reason == "the goal lies outside the map");
    CHECK(room.answer({0.0, bad, 0.0}, {1.0, 0.0, 0.0}).reason == "the start lies outside the map");
  }
}

TEST_CASE("a map without cells, and one of a single cell, refuse in words") {
  const PatternTable table(samplePatterns(), usualSweep(), {});
  for (const int size : {0, 1}) {
    Grid grid(0.1, {0, 0}, size, size);
    for (Cell& cell : grid.cells()) cell = kFree;
    PathPlanner planner(grid, table, usualPaths());
    const PathAnswer answer = planner.answer({{0.05, 0.05, 0.0}, {0.05, 0.05, 0.0}}, after(100));
    CHECK(answer.end == PathEnd::kUnreachable);
    CHECK_FALSE(answer.reason.empty());
  }
}

TEST_CASE("a goal in a thin wall is refused, and come close to as near as the vehicle has room") {
  Grid grid(0.05, {0, 0}, 160, 120);
  for (Cell& cell : grid.cells()) cell = kFree;
  for (int x = 0; x < 120; ++x) grid.set({x, 60}, kObstacle);
  const PatternTable table(samplePatterns(), usualSweep(), {});
  PathPlanner planner(grid, table, usualPaths());
  for (double x = 1.5; x < 5.0; x += 0.5) {
    PathQuery query{{2.0, 1.5, 0.0}, {x, 3.02, 0.0}};
    CAPTURE(x);
    const PathAnswer refused = planner.answer(query, after(20'000));
    CHECK(refused.end == PathEnd::kUnreachable);
    CHECK(refused.reason.find("the goal lies on obstacles") == 0);
    query.come_close = true;
    const PathAnswer close = planner.answer(query, after(20'000));
    REQUIRE(close.end == PathEnd::kSolved);
    REQUIRE(close.closest.has_value());
    CHECK((*close.closest - query.T_map_goal.position()).norm() < 0.5);
    const Pose2 start = query.T_map_start;
    const Pose2 end = close.search.steps.empty() ? start : close.search.steps.back().T_map_end;
    CHECK((end.position() - *close.closest).norm() <= query.position_tolerance);
  }
}

TEST_CASE("a round robot comes as near to a wall as the tolerance says, and close to one inside") {
  for (const double radius : {0.35, 1.0}) {
    for (int column = 100; column < 112; column += 3) {
      Grid grid(0.05, {0, 0}, 160, 120);
      for (Cell& cell : grid.cells()) cell = kFree;
      for (int y = 0; y < 120; ++y)
        for (int x = column; x < 160; ++x) grid.set({x, y}, kObstacle);
      const ClearanceField field(grid, false);
      Grid grown = grid;
      for (int y = 0; y < 120; ++y)
        for (int x = 0; x < 160; ++x)
          if (field.at(grid.centre({x, y})) < radius) grown.set({x, y}, kObstacle);
      PathConfig config = usualPaths();
      config.footprint = {5e-4, 5e-4, 5e-4};
      config.grown = radius;
      config.unknown_blocks = false;
      const PatternTable table(samplePatterns(),
                               SweepResolution{0.05, 0.105, 0.05, config.footprint}, {});
      PathPlanner planner(grown, table, config);
      const double wall = 0.05 * column;
      CAPTURE(radius, wall);
      PathQuery query{{2.0, 3.0, 0.0}, {wall - radius + 0.1, 2.6, 0.0}, 0.25, kPi};
      CHECK(planner.answer(query, after(20'000)).end == PathEnd::kSolved);
      query.T_map_goal.x = wall + 0.1;
      query.come_close = true;
      const PathAnswer close = planner.answer(query, after(20'000));
      CAPTURE(close.reason);
      REQUIRE(close.end == PathEnd::kSolved);
      const double away = wall - close.search.steps.back().T_map_end.x;
      CHECK(away >= radius);
      CHECK(away < 2.0 * radius + 0.3);
    }
  }
}

TEST_CASE("where obstacles were grown coarse cells find the same ways") {
  int solved = 0;
  int lost = 0;
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    PathBench bench(seed);
    Grid grown = bench.grid;
    const ClearanceField field(bench.grid, true);
    for (int y = 0; y < grown.height(); ++y)
      for (int x = 0; x < grown.width(); ++x) {
        const CellIndex cell{grown.lower().x + x, grown.lower().y + y};
        if (field.at(grown.centre(cell)) < 0.35) grown.set(cell, kObstacle);
      }
    PathConfig config = usualPaths();
    config.footprint = {5e-4, 5e-4, 5e-4};
    const PatternTable table(samplePatterns(), SweepResolution{0.05, 0.105, 0.05, config.footprint},
                             {});
    PathPlanner fine(grown, table, config);
    config.grown = 0.35;
    PathPlanner coarse(grown, table, config);
    for (int k = 0; k < 4; ++k) {
      const PathQuery query = bench.query();
      const PathEnd by_fine = fine.answer(query, after(3000)).end;
      const PathEnd by_coarse = coarse.answer(query, after(3000)).end;
      CAPTURE(seed, k);
      if (by_coarse == PathEnd::kUnreachable) CHECK(by_fine == PathEnd::kUnreachable);
      if (by_fine != PathEnd::kSolved) continue;
      ++solved;
      lost += by_coarse == PathEnd::kSolved ? 0 : 1;
    }
  }
  CHECK(solved > 20);
  CHECK(lost <= 1);
}
