// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>
#include <map>
#include <queue>
#include <tuple>

#include "common/pattern/pattern_file.hpp"
#include "tests/planner/kit/search_bench.hpp"
#include "tests/planner/kit/vehicle.hpp"

using namespace tread;
using namespace tread::planner;
using namespace tread::planner::testkit;

namespace {

/// Without penalty and inflation: the cheapest plan at the resolution of the search space.
SearchConfig exact() {
  SearchConfig config;
  config.distance_share = DistanceToGoal::kAdmissibleShare;
  config.heuristic_weight = 1.0;
  config.turn_weight = 0.0;
  config.reverse_penalty = config.stop_penalty = config.near_penalty = config.switch_penalty = 0.0;
  config.horizon = 1000.0;
  config.goal_share = 1.0;
  return config;
}

DistanceFieldConfig plainField() {
  DistanceFieldConfig config = usualField();
  config.tight_weight = 0.0;
  config.reach = 100.0;
  return config;
}

/// Exact test of a pose: every cell under the footprint, without clearance fields and shortcuts.
bool collides(const Grid& grid, const Pose2& pose, double margin) {
  const FootprintSize size = kVehicle;
  const Footprint footprint(size, margin);
  for (const CellIndex cell : footprint.cells(grid, pose))
    if (!isFree(grid.at(cell))) return true;
  return false;
}

bool sweepCollides(const Grid& grid, const Pose2& start, const TablePattern& pattern,
                   double margin) {
  for (const SweptPose& at : pattern.swept_poses)
    if (collides(grid, start * at.pose, margin)) return true;
  return false;
}

/// Least time over the lattice of whole metres and quarter turns, by brute force; infinite if there
/// is none.
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

TEST_CASE("With an exact bound the plan is as cheap as brute force finds it", "[statistics]") {
  Margins margins;
  margins.growth = 0.0;
  int reachable = 0;
  for (uint64_t seed = 1; seed <= 25; ++seed) {
    const Grid grid = yard(seed);
    const Goal goal{1, {4.0, -3.0, kPi / 2.0}, 0.2, 0.2};
    const SearchBench bench(grid, latticePatterns(), goal, margins, plainField());
    const double expected = bruteForce(grid, bench.table, goal, margins.plan);
    PatternSearch search(exact());
    const SearchResult result = search.run(bench.problem({}), after(1'000'000));
    INFO("seed " << seed << ": " << result.reason.words);
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
    PatternSearch search(config);
    const SearchResult result = search.run(bench.problem(mission.T_map_start), after(300'000));
    if (result.end != SearchEnd::kGoal) continue;
    const double whole = result.steps.back().time;
    for (const PlanStep& step : result.steps) {
      const double way = bench.distance_to_goal.length(step.T_map_end.position());
      const double bound =
          (DistanceToGoal::kAdmissibleShare * way - 0.15) / bench.table.bestSpeed();
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
    PatternSearch search(SearchConfig{});
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
  PatternSearch search(SearchConfig{});
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
        PatternSearch search(config);
        const SearchResult result = search.run(bench.problem({0.0, y, heading}), after(15'000));
        INFO(set.content().name << " y " << y << " heading " << heading << " expansions "
                                << result.expansions);
        CHECK(result.end == SearchEnd::kGoal);
      }
    }
  }
}

TEST_CASE(
    "A pattern asks for the room of its own uncertainty, the next one for its start's as well") {
  // A corridor with 0.25 m on both sides. "ahead" ends 0.3 m off: 0.2 m are requested.
  Playground ground;
  for (const double y : {-0.69, 0.69}) ground.addWall({1.0, y}, {12.0, y}, 0.2);
  const Grid grid = ground.paint(0.05, {-3.2, -3.2}, {12.8, 3.2});
  constexpr int kAhead = 1;
  Margins margins;
  margins.largest = 0.45;
  PatternSetContent content = latticePatterns().content();
  content.patterns[0].end_covariance = {0.09, 0.0, 0.0, 0.09, 0.0, 0.0};
  std::string why;
  const auto set = PatternSet::make(std::move(content), why);
  REQUIRE(set);
  const SearchBench bench(grid, *set, {1, {8.0, 0.0, 0.0}, 0.2, 0.2}, margins, plainField());
  PatternSearch search(exact());
  SearchProblem problem = bench.problem({});
  const SearchResult free = search.run(problem, after(100'000));
  REQUIRE(free.end == SearchEnd::kGoal);
  CHECK(free.steps.front().pattern_id == kAhead);
  // The published uncertainty is the accumulated one.
  CHECK(free.steps.back().uncertainty.yy == Approx(0.09 * static_cast<double>(free.steps.size())));
  problem.start_uncertainty.xx = problem.start_uncertainty.yy = 0.36F;
  CHECK(search.run(problem, after(100'000)).steps.empty());
}
