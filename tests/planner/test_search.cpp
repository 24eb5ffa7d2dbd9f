// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>
#include <map>
#include <queue>
#include <tuple>

#include "common/pattern/pattern_file.hpp"
#include "tests/planner/kit/search_bench.hpp"

using namespace tread;
using namespace tread::planner;
using namespace tread::planner::testkit;

namespace {

/// No penalty, no guessing: the cheapest plan at the resolution of the search space.
SearchConfig exact() {
  SearchConfig config;
  config.bound_share = CostToGo::kShare;
  config.bound_weight = 1.0;
  config.turn_weight = 0.0;
  config.reverse_penalty = config.stop_penalty = config.near_penalty = config.switch_penalty = 0.0;
  config.horizon = 1000.0;
  config.goal_share = 1.0;
  return config;
}

FieldConfig plainField() {
  FieldConfig config;
  config.tight_weight = 0.0;
  config.reach = 100.0;
  return config;
}

/// Exact test of a pose: every cell under the footprint, without fields and short cuts.
bool collides(const Grid& grid, const Pose2& pose, double margin) {
  const FootprintSize size;
  const Footprint footprint(size.front, size.rear, size.half_width, margin);
  for (const CellIndex cell : footprint.cells(grid, pose))
    if (!isFree(grid.at(cell))) return true;
  return false;
}

bool sweepCollides(const Grid& grid, const Pose2& start, const TablePattern& pattern,
                   double margin) {
  for (const SweepPose& at : pattern.sweep)
    if (collides(grid, start * at.pose, margin)) return true;
  return false;
}

/// Cheapest time over the lattice of whole metres and quarter turns, by brute force; infinite if
/// there is none.
double bruteForce(const Grid& grid, const PatternTable& table, const Goal& goal, double margin) {
  using State = std::tuple<int, int, int>;
  std::map<State, double> best;
  std::priority_queue<std::pair<double, State>, std::vector<std::pair<double, State>>,
                      std::greater<>>
      open;
  open.push({0.0, {0, 0, 0}});
  while (!open.empty()) {
    const auto [time, state] = open.top();
    open.pop();
    if (!best.emplace(state, time).second) continue;
    const auto [x, y, quarter] = state;
    const Pose2 pose{static_cast<double>(x), static_cast<double>(y), quarter * kPi / 2.0};
    if (std::hypot(pose.x - goal.T_map_goal.x, pose.y - goal.T_map_goal.y) <=
            goal.position_tolerance &&
        std::abs(wrapAngle(pose.yaw - goal.T_map_goal.yaw)) <= goal.yaw_tolerance)
      return time;
    for (const TablePattern& pattern : table.patterns()) {
      if (sweepCollides(grid, pose, pattern, margin)) continue;
      const Pose2 end = pose * pattern.pattern->end();
      const int turned = static_cast<int>(std::lround(end.yaw / (kPi / 2.0)));
      open.push({time + pattern.duration,
                 {static_cast<int>(std::lround(end.x)), static_cast<int>(std::lround(end.y)),
                  ((turned % 4) + 4) % 4}});
    }
  }
  return std::numeric_limits<double>::infinity();
}

Grid yard(uint64_t seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> place(-5.0, 6.0);
  Playground ground;
  ground.addWall({-6.0, -6.0}, {-6.0, 7.0});
  ground.addWall({-6.0, 7.0}, {7.0, 7.0});
  ground.addWall({7.0, 7.0}, {7.0, -6.0});
  ground.addWall({7.0, -6.0}, {-6.0, -6.0});
  for (int i = 0; i < 16; ++i) {
    const Box box{{place(random), place(random), place(random)}, 0.3, 0.3};
    if (std::hypot(box.T_map_box.x, box.T_map_box.y) > 1.3) ground.add(box);
  }
  return ground.paint(0.1, {-8.0, -8.0}, {9.6, 9.6});
}

}  // namespace

TEST_CASE("With an exact bound the plan is as cheap as brute force finds it") {
  Margins margins;
  margins.growth = 0.0;
  int reachable = 0;
  for (uint64_t seed = 1; seed <= 25; ++seed) {
    const Grid grid = yard(seed);
    const Goal goal{1, {4.0, -3.0, kPi / 2.0}, 0.2, 0.2};
    const SearchBench bench(grid, latticePatterns(), goal, margins, plainField());
    const double expected = bruteForce(grid, bench.table, goal, margins.plan);
    Search search(exact());
    const SearchResult result = search.run(bench.problem({}), after(1'000'000));
    INFO("seed " << seed << ": " << result.reason);
    if (std::isinf(expected)) {
      CHECK(result.end != SearchEnd::kGoal);
      continue;
    }
    ++reachable;
    REQUIRE(result.end == SearchEnd::kGoal);
    CHECK(result.cost == Approx(expected).margin(1e-4));
  }
  CHECK(reachable >= 10);
}

TEST_CASE("The bound never exceeds what the rest of a cheapest plan takes") {
  for (const uint64_t seed : {2U, 5U, 9U}) {
    const Mission mission = randomMission(seed);
    const Grid grid = mission.ground.paint(0.1, {-6.4, -12.8}, {38.4, 12.8});
    const SearchBench bench(grid, samplePatterns(), mission.goal, {}, plainField());
    SearchConfig config;
    config.horizon = 1000.0;
    Search search(config);
    const SearchResult result = search.run(bench.problem(mission.T_map_start), after(300'000));
    if (result.end != SearchEnd::kGoal) continue;
    const double whole = result.steps.back().time;
    for (const PlanStep& step : result.steps) {
      const double way = bench.cost_to_go.length(step.T_map_end.position());
      const double bound = (CostToGo::kShare * way - 0.15) / bench.table.bestSpeed();
      CHECK(bound <= whole - step.time + 1e-6);
    }
  }
}

TEST_CASE("No plan touches anything, and after each of its patterns the vehicle can stop") {
  int plans = 0;
  for (uint64_t seed = 1; seed <= 30; ++seed) {
    const Mission mission = randomMission(seed);
    const Grid grid = mission.ground.paint(0.1, {-6.4, -12.8}, {38.4, 12.8});
    const SearchBench bench(grid, samplePatterns(), mission.goal);
    Search search(SearchConfig{});
    const SearchResult result = search.run(bench.problem(mission.T_map_start), after(5'000));
    if (result.steps.empty()) continue;
    ++plans;
    Pose2 pose = mission.T_map_start;
    for (const PlanStep& step : result.steps) {
      const TablePattern& pattern = *bench.table.find(step.pattern_id);
      REQUIRE(!sweepCollides(grid, pose, pattern, Margins{}.plan - 1e-6));
      pose = pose * pattern.pattern->end();
      CHECK(pose.x == Approx(step.T_map_end.x).margin(1e-6));
      if (step.exit_class == bench.table.restClass()) continue;
      bool stops = false;
      for (const TablePattern* stop : bench.table.stopsFrom(step.exit_class))
        stops = stops || !sweepCollides(grid, pose, *stop, Margins{}.plan - 1e-6);
      CHECK(stops);
    }
  }
  CHECK(plans >= 28);
}

TEST_CASE("Patterns join only in the class in which the one before ended") {
  const Mission mission = randomMission(4);
  const Grid grid = mission.ground.paint(0.1, {-6.4, -12.8}, {38.4, 12.8});
  const SearchBench bench(grid, samplePatterns(), mission.goal);
  Search search(SearchConfig{});
  const SearchResult result = search.run(bench.problem(mission.T_map_start), after(20'000));
  int motion_class = bench.table.restClass();
  for (const PlanStep& step : result.steps) {
    CHECK(bench.table.find(step.pattern_id)->entry == motion_class);
    motion_class = step.exit_class;
  }
}

TEST_CASE(
    "A gap of the vehicle's width and 0.4 m is passed, from straight ahead and from the side, "
    "with the patterns of the tests and with the shipped ones") {
  const PatternSet shipped = readPatternFile(TREAD_SOURCE_DIR "/config/patterns/teodor.yaml");
  Playground ground;
  ground.addWall({6.0, -8.0}, {6.0, -0.54}, 0.4);
  ground.addWall({6.0, 0.54}, {6.0, 8.0}, 0.4);
  const Grid grid = ground.paint(0.1, {-8.0, -8.0}, {14.4, 8.0});
  SearchConfig config;
  config.horizon = 1000.0;
  for (const PatternSet& set : {samplePatterns(), shipped}) {
    const SearchBench bench(grid, set, {1, {11.0, 0.0, 0.0}, 0.5, 4.0});
    for (const double y : {0.0, 1.5, -2.5}) {
      for (const double heading : {0.0, 0.5, -0.9}) {
        Search search(config);
        const SearchResult result = search.run(bench.problem({0.0, y, heading}), after(15'000));
        INFO(set.content().name << " y " << y << " heading " << heading << " expansions "
                                << result.expansions);
        CHECK(result.end == SearchEnd::kGoal);
      }
    }
  }
}

TEST_CASE("From the end of a pocket the plan leads out and around") {
  Playground ground;
  ground.addWall({2.5, -2.0}, {2.5, 2.0});
  ground.addWall({-3.0, 2.0}, {2.5, 2.0});
  ground.addWall({-3.0, -2.0}, {2.5, -2.0});
  const Grid grid = ground.paint(0.1, {-9.6, -8.0}, {12.8, 8.0});
  const SearchBench bench(grid, samplePatterns(), {1, {9.0, 0.0, 0.0}, 0.5, 4.0});
  SearchConfig config;
  config.horizon = 1000.0;
  Search search(config);
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
  Search search(config);
  const SearchResult result = search.run(bench.problem(mission.T_map_start), after(48));
  CHECK(result.end == SearchEnd::kProgress);
  CHECK(result.expansions <= 64);
  REQUIRE(!result.steps.empty());
  CHECK(result.way_to_go < bench.cost_to_go.length(mission.T_map_start.position()));
}

TEST_CASE("At the border of the known the plan ends in front of it, free and able to stop") {
  Playground ground;
  const Grid grid = ground.paint(0.1, {-6.4, -6.4}, {6.4, 6.4});
  const SearchBench bench(grid, samplePatterns(), {1, {30.0, 0.0, 0.0}, 0.5, 4.0});
  Search search(SearchConfig{});
  const SearchResult result = search.run(bench.problem({}), after(20'000));
  REQUIRE(result.end == SearchEnd::kHorizon);
  CHECK(result.steps.back().T_map_end.x > 3.0);
  CHECK(result.steps.back().T_map_end.x < 6.4);
  CHECK(result.expansions < 200);
}

TEST_CASE("Boxed in, nothing is found and it says so") {
  Playground ground;
  ground.addWall({-0.9, -0.6}, {0.9, -0.6}, 0.1);
  ground.addWall({-0.9, 0.6}, {0.9, 0.6}, 0.1);
  ground.addWall({-0.9, -0.6}, {-0.9, 0.6}, 0.1);
  ground.addWall({0.9, -0.6}, {0.9, 0.6}, 0.1);
  const Grid grid = ground.paint(0.1, {-6.4, -6.4}, {12.8, 6.4});
  // Seen from the way to go there must be one: the goal is taken near.
  SearchBench bench(grid, samplePatterns(), {1, {0.8, 0.0, 0.0}, 0.3, 4.0});
  Search search(SearchConfig{});
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
  REQUIRE(bench.surroundings.overlap({}).obstacles > 0);
  Search search(SearchConfig{});
  const SearchResult result = search.run(bench.problem({}), after(20'000));
  REQUIRE(!result.steps.empty());
  const Overlap at_start = bench.surroundings.overlap({});
  const TablePattern& first = *bench.table.find(result.steps.front().pattern_id);
  for (const SweepPose& at : first.sweep)
    CHECK(bench.surroundings.overlap(at.pose).within(at_start));
  CHECK(bench.surroundings.overlap(result.steps.front().T_map_end).none());
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
  Search search(config);
  const SearchResult result = search.run(bench.problem({}), after(20'000));
  REQUIRE(result.steps.size() > 3);
  Pose2 pose;
  size_t used = 0;
  while (!bench.surroundings.overlap(pose).none()) {
    const Overlap before = bench.surroundings.overlap(pose);
    const TablePattern& pattern = *bench.table.find(result.steps[used++].pattern_id);
    for (const SweepPose& at : pattern.sweep)
      REQUIRE(bench.surroundings.overlap(pose * at.pose).within(before));
    pose = pose * pattern.pattern->end();
  }
  CHECK(used <= 3);
}

TEST_CASE("A plan is kept while another is hardly better, and left when it is blocked") {
  const auto plan = [](bool boulder_moved, bool block_right, std::vector<int> committed) {
    Playground ground;
    // A boulder straight ahead, a little nearer to one side: both ways around are nearly equal.
    ground.add({{4.0, boulder_moved ? 0.04 : -0.04, 0.0}, 0.5, 0.5});
    if (block_right) ground.addWall({4.0, -8.0}, {4.0, 0.0});
    const Grid grid = ground.paint(0.02, {-2.0, -6.0}, {12.0, 6.0});
    const SearchBench bench(grid, samplePatterns(), {1, {9.0, 0.0, 0.0}, 0.5, 4.0});
    Search search(SearchConfig{});
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
  REQUIRE(first.second * second.second < 0.0);  // without memory it flips
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
  Search search(SearchConfig{});
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
