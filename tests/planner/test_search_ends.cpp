// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Where a search ends, where it may start, and what it keeps of the previous plan.
#include <catch2/catch.hpp>

#include <cmath>

#include "tests/planner/kit/search_bench.hpp"

using namespace tread;
using namespace tread::planner;
using namespace tread::planner::testkit;

TEST_CASE("From the end of a pocket the plan leads out and around") {
  Playground ground;
  ground.addWall({2.5, -2.0}, {2.5, 2.0});
  ground.addWall({-3.0, 2.0}, {2.5, 2.0});
  ground.addWall({-3.0, -2.0}, {2.5, -2.0});
  const Grid grid = ground.paint(0.1, {-9.6, -8.0}, {12.8, 8.0});
  const SearchBench bench(grid, samplePatterns(), {1, {9.0, 0.0, 0.0}, 0.5, 4.0});
  SearchConfig config;
  config.horizon = 1000.0;
  PatternSearch search(config);
  const SearchResult result = search.run(bench.problem({1.2, 0.0, 0.0}), after(50'000));
  CHECK(result.end == SearchEnd::kGoal);
}

TEST_CASE(
    "A search that is cut off returns the best that it has, nearer to the goal and stoppable") {
  const Mission mission = randomMission(8);
  const Grid grid = mission.ground.paint(0.1, {-6.4, -12.8}, {38.4, 12.8});
  const SearchBench bench(grid, samplePatterns(), mission.goal);
  SearchConfig config;
  config.horizon = 1000.0;
  PatternSearch search(config);
  const SearchResult result = search.run(bench.problem(mission.T_map_start), after(48));
  CHECK(result.end == SearchEnd::kProgress);
  CHECK(result.expansions <= 64);
  REQUIRE(!result.steps.empty());
  CHECK(result.distance_to_go < bench.distance_to_goal.length(mission.T_map_start.position()));
}

TEST_CASE("At the border of the known the plan ends in front of it, free and able to stop") {
  Playground ground;
  const Grid grid = ground.paint(0.1, {-6.4, -6.4}, {6.4, 6.4});
  const SearchBench bench(grid, samplePatterns(), {1, {30.0, 0.0, 0.0}, 0.5, 4.0});
  PatternSearch search(SearchConfig{});
  const SearchResult result = search.run(bench.problem({}), after(20'000));
  REQUIRE(result.end == SearchEnd::kHorizon);
  CHECK(result.steps.back().T_map_end.x > 3.0);
  CHECK(result.steps.back().T_map_end.x < 6.4);
  CHECK(result.expansions < 200);
}

TEST_CASE("In the goal a stop is found before all that is around it has been expanded") {
  Playground ground;
  const Grid grid = ground.paint(0.1, {-6.4, -6.4}, {12.8, 6.4});
  const SearchBench bench(grid, samplePatterns(), {1, {6.0, 1.0, 0.0}, 1.0, 4.0});
  PatternSearch search(SearchConfig{});
  const SearchResult result = search.run(bench.problem({}), after(20'000));
  REQUIRE(result.end == SearchEnd::kGoal);
  CHECK(result.expansions < 60);
}

TEST_CASE("Boxed in, nothing is found and it says so") {
  Playground ground;
  ground.addWall({-0.9, -0.6}, {0.9, -0.6}, 0.1);
  ground.addWall({-0.9, 0.6}, {0.9, 0.6}, 0.1);
  ground.addWall({-0.9, -0.6}, {-0.9, 0.6}, 0.1);
  ground.addWall({0.9, -0.6}, {0.9, 0.6}, 0.1);
  const Grid grid = ground.paint(0.1, {-6.4, -6.4}, {12.8, 6.4});
  // As judged by the distance to the goal there must be a path: the goal is close.
  SearchBench bench(grid, samplePatterns(), {1, {0.8, 0.0, 0.0}, 0.3, 4.0});
  PatternSearch search(SearchConfig{});
  const SearchResult result = search.run(bench.problem({}), after(20'000));
  CHECK(result.end == SearchEnd::kNothing);
  CHECK(result.steps.empty());
  CHECK(!result.reason.empty());
}

TEST_CASE("From a start on blocked ground only patterns that do not make it worse are taken") {
  Playground ground;
  Grid grid = ground.paint(0.1, {-6.4, -6.4}, {12.8, 6.4});
  for (int y = -3; y <= 3; ++y) grid.set({-6, y}, kObstacle);  // under the tail
  const SearchBench bench(grid, samplePatterns(), {1, {6.0, 0.0, 0.0}, 0.5, 4.0});
  REQUIRE(bench.collision_checker.overlap({}).obstacles > 0);
  PatternSearch search(SearchConfig{});
  const SearchResult result = search.run(bench.problem({}), after(20'000));
  REQUIRE(!result.steps.empty());
  const Overlap at_start = bench.collision_checker.overlap({});
  const TablePattern& first = *bench.table.find(result.steps.front().pattern_id);
  for (const SweptPose& at : first.swept_poses)
    CHECK(bench.collision_checker.overlap(at.pose).within(at_start));
  CHECK(bench.collision_checker.overlap(result.steps.front().T_map_end).none());
}

TEST_CASE(
    "With its nose on blocked ground the vehicle does not go on, but gets off it in a few "
    "patterns") {
  Playground ground;
  Grid grid = ground.paint(0.1, {-6.4, -6.4}, {12.8, 6.4});
  for (int y = -4; y <= 4; ++y) grid.set({5, y}, kObstacle);
  const SearchBench bench(grid, samplePatterns(), {1, {6.0, 0.0, 0.0}, 0.5, 4.0});
  SearchConfig config;
  config.horizon = 1000.0;
  PatternSearch search(config);
  const SearchResult result = search.run(bench.problem({}), after(20'000));
  REQUIRE(result.steps.size() > 3);
  Pose2 pose;
  size_t used = 0;
  while (!bench.collision_checker.overlap(pose).none()) {
    const Overlap before = bench.collision_checker.overlap(pose);
    const TablePattern& pattern = *bench.table.find(result.steps[used++].pattern_id);
    for (const SweptPose& at : pattern.swept_poses)
      REQUIRE(bench.collision_checker.overlap(pose * at.pose).within(before));
    pose = pose * pattern.pattern->end();
  }
  CHECK(used <= 3);
}

TEST_CASE("A plan is kept while another is hardly better, and left when it is blocked") {
  const auto plan = [](bool boulder_moved, bool block_right, std::vector<int> committed) {
    Playground ground;
    // A boulder straight ahead, slightly off to one side: both ways around are nearly equal.
    ground.add({{4.0, boulder_moved ? 0.04 : -0.04, 0.0}, 0.5, 0.5});
    if (block_right) ground.addWall({4.0, -8.0}, {4.0, 0.0});
    const Grid grid = ground.paint(0.02, {-2.0, -6.0}, {12.0, 6.0});
    const SearchBench bench(grid, samplePatterns(), {1, {9.0, 0.0, 0.0}, 0.5, 4.0});
    PatternSearch search(SearchConfig{});
    SearchProblem task = bench.problem({1.0, 0.0, 0.0}, "cruise");
    task.committed = std::move(committed);
    const SearchResult result = search.run(task, after(20'000));
    std::pair<std::vector<int>, double> found;
    for (const PlanStep& step : result.steps) {
      found.first.push_back(step.pattern_id);
      if (std::abs(step.T_map_end.x - 4.0) < 1.0) found.second = step.T_map_end.y;
    }
    return found;
  };
  const auto first = plan(true, false, {});
  const auto second = plan(false, false, {});
  REQUIRE(first.second != 0.0);
  REQUIRE(first.second * second.second < 0.0);  // without hysteresis it flips
  const auto kept = plan(false, false, first.first);
  CHECK(kept.second * first.second > 0.0);
  const auto& right = first.second < 0.0 ? first : second;
  const auto left = plan(false, true, right.first);
  CHECK(left.second > 0.0);
}

TEST_CASE("The drawn tree has every parent before its children, and the branch in it") {
  const Mission mission = randomMission(6);
  const Grid grid = mission.ground.paint(0.1, {-6.4, -12.8}, {38.4, 12.8});
  const SearchBench bench(grid, samplePatterns(), mission.goal);
  PatternSearch search(SearchConfig{});
  const SearchResult result = search.run(bench.problem(mission.T_map_start), after(20'000));
  for (const size_t count : {5U, 50U, 5000U}) {
    const std::vector<TreeNode> tree = search.tree(count);
    CHECK(tree.size() <= std::max(count, result.steps.size() + 1));
    for (size_t i = 1; i < tree.size(); ++i) {
      REQUIRE(tree[i].parent >= 0);
      CHECK(tree[i].parent < static_cast<int>(i));
    }
    REQUIRE(search.branch().size() == result.steps.size() + 1);
    for (const int i : search.branch()) CHECK(i >= 0);
  }
}
