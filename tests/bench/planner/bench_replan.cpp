// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// One cycle of the planner after a change of everything: the local map of 40 x 40 m at 10 cm, and
// the pattern set. As a ratio to the clearance transform of that map, timed between the cycles.
#include "modules/planner/core/execution/motion_planner.hpp"
#include "modules/planner/core/execution/supervisor.hpp"
#include "modules/planner/core/search/pattern_search.hpp"
#include "tests/bench/planner/path_figures.hpp"
#include "tests/planner/kit/playground.hpp"
#include "tests/planner/kit/sample_patterns.hpp"
#include "tests/planner/kit/vehicle.hpp"

namespace {

using namespace tread;
using namespace tread::planner;
using namespace tread::planner::testkit;

constexpr double kSide = 40.0;  // [m]

/// The first fifteen driving patterns of the samples.
PatternSet fifteenPatterns(double turn_error) {
  PatternSetContent content = samplePatterns(1, turn_error).content();
  if (content.patterns.size() > 15) content.patterns.resize(15);
  std::vector<MotionClass> used;
  for (const MotionClass& motion_class : content.classes)
    for (const MotionPattern& pattern : content.patterns)
      if (pattern.entry_class == motion_class.name || pattern.exit_class == motion_class.name) {
        used.push_back(motion_class);
        break;
      }
  content.classes = used;
  std::string why;
  const std::optional<PatternSet> set = PatternSet::make(std::move(content), why);
  if (!set) throw std::logic_error(why);
  return *set;
}

/// A cycle: clearance and distance to the goal for the changed map, the table for the changed set,
/// the search.
void replan(benchmark::State& state) {
  PlanningMapConfig config = usualMap();
  config.window = kSide;
  config.window_period = config.field_period = 0;
  std::vector<double> cycles, transforms;
  uint64_t seed = 0;
  int64_t now = 0;
  std::vector<PlanningMap> maps(20, PlanningMap(config));
  std::vector<Mission> missions;
  std::vector<Grid> grids;
  std::vector<std::vector<Tile>> tiles;
  for (size_t i = 0; i < maps.size(); ++i) {
    missions.push_back(randomMission(i + 1));
    grids.push_back(missions[i].ground.paint(0.1, {-16.0, -19.2}, {24.0, 20.8}));
    tiles.push_back(tilesOf(grids[i], ToyMapping::kTileCells, 1));
    // The robot has been there for some time.
    for (const Tile& tile : tiles[i]) maps[i].put(tile, ToyMapping::kCell, ToyMapping::kTileCells);
    maps[i].updateCollisionChecker(missions[i].T_map_start, 1);
    maps[i].updateDistance(missions[i].T_map_start, missions[i].goal, 1);
  }
  PatternSearch search(SearchConfig{});
  for (auto _ : state) {
    const size_t i = seed++ % maps.size();
    const Mission& mission = missions[i];
    now += 1'000'000;
    const PatternSet set = fifteenPatterns(1.0 + 0.01 * static_cast<double>(seed % 7));
    // An obstacle appears and disappears, so that each map differs from the previous one.
    for (Tile& tile : tiles[i]) {
      tile.utime = now;
      Cell& cell = tile.cells[tile.cells.size() / 3];
      cell = cell == kObstacle ? kFree : kObstacle;
    }
    for (const Tile& tile : tiles[i]) maps[i].put(tile, ToyMapping::kCell, ToyMapping::kTileCells);
    const bench::StopWatch watch;
    maps[i].updateCollisionChecker(mission.T_map_start, now);
    maps[i].updateDistance(mission.T_map_start, mission.goal, now);
    const PatternTable table(set, usualSweep(), {});
    SearchProblem problem;
    problem.T_map_start = mission.T_map_start;
    problem.start_class = table.restClass();
    problem.patterns = &table;
    problem.collision_checker = &maps[i].collisionChecker();
    problem.distance_to_goal = &maps[i].distanceToGoal();
    problem.goal = mission.goal;
    benchmark::DoNotOptimize(
        search.run(problem, [](int count) { return count >= PolicyConfig{}.driving_expansions; }));
    cycles.push_back(watch.ms());
    transforms.push_back(bench::transformTime(grids[i]));
  }
  const double reference = bench::quantile(transforms, 0.5);
  bench::countQuantiles(state, "cycle", cycles);
  state.counters["transform_ms"] = reference;
  state.counters["p50_over_transform"] = bench::quantile(cycles, 0.5) / reference;
  state.counters["p99_over_transform"] = bench::quantile(cycles, 0.99) / reference;
}
BENCHMARK(replan)->Unit(benchmark::kMillisecond)->Iterations(400);

}  // namespace
