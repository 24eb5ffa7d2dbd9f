// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <benchmark/benchmark.h>

#include <set>
#include <stdexcept>

#include "modules/planner/core/execution/motion_planner.hpp"
#include "modules/planner/core/map/clearance_map.hpp"
#include "modules/planner/core/search/pattern_search.hpp"
#include "tests/planner/kit/playground.hpp"
#include "tests/planner/kit/sample_patterns.hpp"
#include "tests/planner/kit/vehicle.hpp"

namespace {

using namespace tread;
using namespace tread::planner;
using namespace tread::planner::testkit;

/// A mission with a completely known map.
struct Scene {
  explicit Scene(uint64_t seed)
      : mission(randomMission(seed)),
        map(ToyMapping::kCell, ToyMapping::kTileCells, ClearanceMapConfig{}) {
    const Grid grid = mission.ground.paint(ToyMapping::kCell, {-16.0, -16.0}, {48.0, 16.0});
    tiles = tilesOf(grid, ToyMapping::kTileCells, 1);
    for (const Tile& tile : tiles) map.put(tile);
    map.refresh();
  }
  Grid window() const { return map.window({-120, -120}, 240, 240); }
  DistanceToGoal field() const {
    return DistanceToGoal(map, mission.goal, mission.T_map_start.position(), {}, usualField());
  }

  Mission mission;
  std::vector<Tile> tiles;
  ClearanceMap map;
};

void cutSurroundings(benchmark::State& state) {
  const Scene scene(3);
  for (auto _ : state)
    benchmark::DoNotOptimize(CollisionChecker(scene.window(), kVehicle, Margins{}));
}
BENCHMARK(cutSurroundings)->Unit(benchmark::kMicrosecond);

void takeAndRefreshTile(benchmark::State& state) {
  Scene scene(3);
  Tile tile = scene.tiles[scene.tiles.size() / 2];
  for (auto _ : state) {
    ++tile.utime;
    tile.cells[500] = tile.cells[500] == kObstacle ? kFree : kObstacle;
    scene.map.put(tile);
    scene.map.refresh();
  }
}
BENCHMARK(takeAndRefreshTile)->Unit(benchmark::kMicrosecond);

void wayToGo(benchmark::State& state) {
  const Scene scene(3);
  int64_t filled = 0;
  for (auto _ : state) filled += scene.field().filled();
  state.counters["cells/s"] =
      benchmark::Counter(static_cast<double>(filled), benchmark::Counter::kIsRate);
}
BENCHMARK(wayToGo)->Unit(benchmark::kMicrosecond);

void preparePatterns(benchmark::State& state) {
  const PatternSet set = samplePatterns();
  for (auto _ : state) benchmark::DoNotOptimize(PatternTable(set, usualSweep(), {}));
}
BENCHMARK(preparePatterns)->Unit(benchmark::kMicrosecond);

/// The paper's five patterns, plus those that start and stop.
PatternSet fivePatterns() {
  const std::set<std::string> wanted = {"straight",   "left",  "right", "hard_left",
                                        "hard_right", "start", "stop"};
  PatternSetContent content = samplePatterns().content();
  std::vector<MotionPattern> kept;
  for (const MotionPattern& pattern : content.patterns)
    if (wanted.count(pattern.name) > 0) kept.push_back(pattern);
  content.patterns = kept;
  content.classes.pop_back();  // no driving backwards
  std::string why;
  const std::optional<PatternSet> set = PatternSet::make(std::move(content), why);
  if (!set) throw std::logic_error(why);
  return *set;
}

/// Worlds with all inputs of a search.
struct Worlds {
  explicit Worlds(const PatternSet& set) : table(set, usualSweep(), {}) {
    for (uint64_t seed = 1; seed <= 10; ++seed) scenes.emplace_back(seed);
    for (const Scene& scene : scenes) {
      around.emplace_back(scene.window(), kVehicle, Margins{});
      fields.push_back(scene.field());
    }
  }
  SearchProblem problem(size_t i) const {
    SearchProblem problem;
    problem.T_map_start = scenes[i].mission.T_map_start;
    problem.start_class = table.restClass();
    problem.patterns = &table;
    problem.collision_checker = &around[i];
    problem.distance_to_goal = &fields[i];
    problem.goal = scenes[i].mission.goal;
    return problem;
  }

  PatternTable table;
  std::vector<Scene> scenes;
  std::vector<CollisionChecker> around;
  std::vector<DistanceToGoal> fields;
};

void searchWorlds(benchmark::State& state, const PatternSet& set, const SearchConfig& config) {
  const Worlds worlds(set);
  PatternSearch engine(config);
  int64_t expansions = 0;
  size_t turn = 0;
  for (auto _ : state) {
    const SearchProblem problem = worlds.problem(turn++ % worlds.scenes.size());
    expansions += engine.run(problem, [](int count) { return count >= 20000; }).expansions;
  }
  state.counters["expansions/s"] =
      benchmark::Counter(static_cast<double>(expansions), benchmark::Counter::kIsRate);
  state.counters["expansions"] =
      benchmark::Counter(static_cast<double>(expansions), benchmark::Counter::kAvgIterations);
}

/// As on the robot: up to the horizon.
void searchAhead(benchmark::State& state) {
  searchWorlds(state, samplePatterns(), {});
}
BENCHMARK(searchAhead)->Unit(benchmark::kMillisecond)->MinTime(2.0);

/// With an unreachable horizon the whole budget of expansions is spent.
void searchOn(benchmark::State& state) {
  SearchConfig config;
  config.horizon = 1000.0;
  searchWorlds(state, state.range(0) == 5 ? fivePatterns() : samplePatterns(), config);
}
BENCHMARK(searchOn)->Arg(5)->Arg(20)->Unit(benchmark::kMillisecond)->MinTime(2.0);

}  // namespace
