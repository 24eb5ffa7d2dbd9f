// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>

#include "common/pattern/pattern_file.hpp"
#include "modules/planner/core/map/ground_cost.hpp"
#include "tests/planner/kit/search_bench.hpp"

using namespace tread;
using namespace tread::planner;
using namespace tread::planner::testkit;

namespace {

const PatternSet& twoSpeeds() {
  static const PatternSet set =
      readPatternFile(TREAD_SOURCE_DIR "/config/patterns/teodor_speeds.yaml");
  return set;
}

/// 40 m x 16 m of free ground; cells from x = 8 m to 16 m have a cost.
Grid ground(Cell cost, double from = 8.0, double to = 16.0, double half_width = 8.0) {
  Grid grid(0.1, {-40, -80}, 400, 160);
  for (int y = -80; y < 80; ++y)
    for (int x = -40; x < 360; ++x) {
      const Eigen::Vector2d p = grid.centre({x, y});
      const bool rough = p.x() > from && p.x() < to && std::abs(p.y()) < half_width;
      grid.set({x, y}, rough ? cost : Cell{1});
    }
  return grid;
}

/// A certain model: 1 m/s2 on 1 cm at 1 m/s.
ShockKnowledge known() {
  ShockKnowledge shock;
  shock.model.mean = {0.0, 1.0, 2.0};
  shock.model.covariance.setZero();
  shock.model.variance = 0.0;
  return shock;
}

/// Mean speed of a plan's patterns that begin between two places [m/s].
double speedBetween(const SearchResult& plan, const PatternTable& table, double from, double to) {
  double length = 0.0, time = 0.0, x = 0.0;
  for (const PlanStep& step : plan.steps) {
    const TablePattern& pattern = *table.find(step.pattern_id);
    if (x >= from && x < to) {
      length += pattern.length;
      time += pattern.duration;
    }
    x = step.T_map_end.x;
  }
  return length / time;
}

}  // namespace

TEST_CASE("ground costs what shock is above what is harmless, for the time on it") {
  const SearchBench bench(ground(10), twoSpeeds(), {1, {30.0, 0.0, 0.0}, 0.5, 4.0});
  const GroundCost cost({2.0, 0.5}, known(), bench.table);
  const int fast = twoSpeeds().patterns()[0].id;  // straight: 1.084 m in 1 s
  const TablePattern& straight = *bench.table.find(fast);
  const double speed = straight.length / straight.duration;
  const Grid& grid = bench.collision_checker.grid();
  CHECK(cost.cost(grid, turned({10.0, 0.0, 0.3}), straight) ==
        Approx(2.0 * (speed * speed / 0.5 - 1.0) * straight.duration).epsilon(1e-3));
  CHECK(cost.cost(grid, turned({0.0, 0.0, 0.3}), straight) == 0.0);
  CHECK(cost.slowness()[1] == Approx(1.0));
  CHECK(cost.slowness()[10] > 1.2);
  CHECK(cost.slowness()[20] >= cost.slowness()[10]);
}

TEST_CASE("where nothing was seen the ground is as it was felt, and free where nothing was felt") {
  const SearchBench bench(ground(kFree), twoSpeeds(), {1, {30.0, 0.0, 0.0}, 0.5, 4.0});
  const TablePattern& straight = *bench.table.find(twoSpeeds().patterns()[0].id);
  const Grid& grid = bench.collision_checker.grid();
  ShockKnowledge shock = known();
  CHECK(GroundCost({1.0, 0.5}, shock, bench.table).cost(grid, turned({10.0, 0.0, 0.0}), straight) ==
        0.0);
  shock.here = 1.0;
  CHECK(GroundCost({1.0, 0.5}, shock, bench.table).cost(grid, turned({10.0, 0.0, 0.0}), straight) >
        1.0);
}

TEST_CASE("ground that nobody saw is as rough as the nearest that somebody did") {
  std::vector<Cell> costs(20 * 10, kFree);
  costs[5 * 20 + 3] = 7;
  costs[5 * 20 + 15] = 30;
  spreadRoughness(costs, 20, 6);
  CHECK(costs[5 * 20 + 8] == 7);
  CHECK(costs[2 * 20 + 1] == 7);
  CHECK(costs[5 * 20 + 10] == 30);
  CHECK(costs[9 * 20 + 15] == 30);
  CHECK(costs[0 * 20 + 7] == kFree);  // nine steps from the first one, too far
  Grid grid(0.1, {0, 0}, 30, 30);
  for (Cell& cell : grid.cells()) cell = kFree;
  grid.set({3, 3}, 9);
  grid.set({4, 3}, kObstacle);
  grid.set({5, 3}, kUnknown);
  spreadRoughness(grid, 1.0);
  CHECK(grid.at({4, 3}) == kObstacle);
  CHECK(grid.at({5, 3}) == kUnknown);
  CHECK(grid.at({6, 3}) == 9);
  CHECK(grid.at({29, 29}) == kFree);
}

TEST_CASE("a plan slows down on rough ground and nowhere else") {
  SearchBench bench(ground(15), twoSpeeds(), {1, {25.0, 0.0, 0.0}, 0.5, 4.0});
  SearchConfig config;
  config.horizon = 1000.0;
  for (const double weight : {0.0, 1.0}) {
    const GroundCost cost({2.0 * weight, 0.4}, known(), bench.table);
    DistanceFieldConfig field = usualField();
    field.slowness.assign(cost.slowness().begin(), cost.slowness().end());
    bench.distance_to_goal = DistanceToGoal(bench.map, bench.goal, {0.0, 0.0}, {}, field);
    SearchProblem problem = bench.problem({0.0, 0.0, 0.0});
    problem.ground = &cost;
    PatternSearch search(config);
    const SearchResult plan = search.run(problem, after(200'000));
    INFO("weight " << weight << ", expansions " << plan.expansions);
    REQUIRE(plan.end == SearchEnd::kGoal);
    CHECK(speedBetween(plan, bench.table, 1.0, 5.5) > 0.95);
    CHECK(speedBetween(plan, bench.table, 18.5, 22.0) > 0.85);
    if (weight > 0.0)
      CHECK(speedBetween(plan, bench.table, 8.0, 15.0) < 0.65);
    else
      CHECK(speedBetween(plan, bench.table, 8.0, 15.0) > 0.95);
  }
}

TEST_CASE("the distance to the goal leads round rough ground where that is worth it") {
  const Grid grid = ground(40, 8.0, 12.0, 3.0);
  SearchBench bench(grid, twoSpeeds(), {1, {20.0, 0.0, 0.0}, 0.5, 4.0});
  DistanceFieldConfig field = usualField();
  const double straight = bench.distance_to_goal.length({0.0, 0.0});
  const GroundCost cost({1.0, 0.3}, known(), bench.table);
  field.slowness.assign(cost.slowness().begin(), cost.slowness().end());
  bench.distance_to_goal = DistanceToGoal(bench.map, bench.goal, {0.0, 0.0}, {}, field);
  const double around = bench.distance_to_goal.length({0.0, 0.0});
  CHECK(straight == Approx(19.5).margin(0.5));
  CHECK(around > straight + 0.5);
  CHECK(around < straight + 3.0);
  double farthest = 0.0;
  for (const Eigen::Vector2d& p : bench.distance_to_goal.descend({0.0, 0.0}, 0.2, 90))
    farthest = std::max(farthest, std::abs(p.y()));
  CHECK(farthest > 2.5);
}

TEST_CASE("under a top speed only slow patterns are begun, and stopping stays possible") {
  const PatternTable table(twoSpeeds(), usualSweep(), {}, 0.6);
  CHECK(table.defect().empty());
  CHECK(table.bestSpeed() <= 0.6);
  for (int i = 0; i < table.classCount(); ++i)
    for (const TablePattern* pattern : table.from(i))
      if (i != table.classIndex("cruise")) CHECK(pattern->length / pattern->duration <= 0.6);
  // Above the allowed speed only slowing patterns are available.
  CHECK_FALSE(table.from(table.classIndex("cruise")).empty());
  for (const TablePattern* pattern : table.from(table.classIndex("cruise")))
    CHECK(table.motionClass(pattern->exit).twist.v_x <= 0.6);
  CHECK(table.stopsFrom(table.classIndex("cruise")).size() == 1);
  const PatternTable all(twoSpeeds(), usualSweep(), {});
  CHECK(all.bestSpeed() > 1.0);
}
