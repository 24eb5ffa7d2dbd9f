// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Plans on whole maps: other planners' scenarios (in the folder TREAD_RECORDINGS; skipped if
// absent) and our own. Times are wall time; `over_transform` is their ratio to the median of the
// clearance transform of the same map, timed in the same run.
#include <cstdlib>
#include <filesystem>

#include "tests/bench/planner/path_figures.hpp"
#include "tools/lab/plan/plan_report.hpp"
#include "tools/lab/plan/task_planner.hpp"

namespace {

using namespace tread;
using namespace tread::plan;
using bench::quantile;

const char* const kOwnMaps = TREAD_SOURCE_DIR "/tests/data/planning/";
const char* const kOwnPatterns = TREAD_SOURCE_DIR "/config/patterns/teodor.yaml";
constexpr double kDeadline = 100.0;  // [ms]
constexpr size_t kQueries = 500;

/// A map and a set; relative paths are in the folder of recordings.
struct Scenario {
  const char* name;
  std::string map;
  std::string patterns;
  double side;  // [m] of the square footprint; 0 = teodor's own
};

std::string found(const std::string& path) {
  if (path.front() == '/') return path;
  const char* folder = std::getenv("TREAD_RECORDINGS");
  return folder == nullptr ? path : std::string(folder) + "/planning/" + path;
}

/// Reads a scenario; skips the benchmark if a file is missing.
std::optional<PlanTask> load(benchmark::State& state, const Scenario& scenario, bool many) {
  PlanOptions options;
  options.map = found(scenario.map);
  options.patterns = found(scenario.patterns);
  if (!std::filesystem::exists(options.map) || !std::filesystem::exists(options.patterns)) {
    state.SkipWithError("skipped: the planning scenarios are not here (TREAD_RECORDINGS)");
    return std::nullopt;
  }
  options.footprint = scenario.side > 0.0
                          ? std::to_string(scenario.side) + "," + std::to_string(scenario.side)
                          : "1.47,0.83";
  options.deadline_ms = kDeadline;
  if (many) options.random = kQueries;
  return loadTask(options);
}

/// Plans from the map's own start to its goal; includes all work except for reading the files.
void oneGoal(benchmark::State& state, const Scenario& scenario) {
  const std::optional<PlanTask> task = load(state, scenario, false);
  if (!task) return;
  std::vector<double> first;
  PlanAnswer answer;
  for (auto _ : state) {
    TaskPlanner planner(*task);
    answer = planner.answer(task->queries.front(), planner.preparationMs());
    addPreparation(answer, planner.preparationMs());
    first.push_back(answer.first_solution_ms.value_or(std::nan("")));
  }
  state.counters["first_p50_ms"] = quantile(first, 0.5);
  state.counters["first_over_transform"] =
      quantile(first, 0.5) / bench::medianTransform(task->grid);
  state.counters["cost"] = answer.cost;
  state.counters["memory_mb"] = answer.memory_mb;
}

/// Random queries in sequence on one map.
void manyGoals(benchmark::State& state, const Scenario& scenario) {
  const std::optional<PlanTask> task = load(state, scenario, true);
  if (!task) return;
  std::vector<double> first, total, refused;
  double expansions = 0.0;
  double searching = 0.0;
  for (auto _ : state) {
    TaskPlanner planner(*task);
    for (const PlanQuery& query : task->queries) {
      const PlanAnswer answer = planner.answer(query);
      if (answer.end == planner::PathEnd::kUnreachable)
        refused.push_back(answer.total_ms);
      else
        total.push_back(answer.total_ms);
      if (answer.end == planner::PathEnd::kSolved) first.push_back(*answer.first_solution_ms);
      expansions += static_cast<double>(answer.expansions);
      searching += answer.total_ms - answer.heuristic_ms;
    }
  }
  const double asked = static_cast<double>(total.size() + refused.size());
  state.counters["solved"] = static_cast<double>(first.size()) / asked;
  bench::countQuantiles(state, "first", first);
  bench::countQuantiles(state, "total", total);
  state.counters["refused_max_ms"] = quantile(refused, 1.0);
  state.counters["expansions_per_s"] = 1e3 * expansions / searching;
  state.counters["first_p99_over_transform"] =
      quantile(first, 0.99) / bench::medianTransform(task->grid);
}

const Scenario kOneGoal[] = {
    {"cubicle_pr2", "sbpl/cubicle-25mm-inflated-env.cfg", "sbpl/pr2.mprim", 0.65},
    {"cubicle_non_uniform", "sbpl/cubicle-25mm-inflated-env.cfg",
     "sbpl/non_uniform_res0025_rad1_err005.mprim", 0.65},
    {"cubicle_all_file", "sbpl/cubicle-25mm-inflated-env.cfg", "sbpl/all_file.mprim", 0.65},
    {"env2_pr2_10cm", "sbpl/env2.cfg", "sbpl/pr2_10cm.mprim", 0.65},
};
const Scenario kManyGoals[] = {
    {"depot_pr2", "maps/depot.yaml", "sbpl/pr2.mprim", 0.65},
    {"depot_non_uniform", "maps/depot.yaml", "sbpl/non_uniform_res0025_rad1_err005.mprim", 0.65},
    {"depot_teodor", "maps/depot.yaml", kOwnPatterns, 0.0},
    {"office_teodor", std::string(kOwnMaps) + "office.yaml", kOwnPatterns, 0.0},
    {"forest_teodor", std::string(kOwnMaps) + "forest.yaml", kOwnPatterns, 0.0},
    {"dead_end_teodor", std::string(kOwnMaps) + "dead_end.yaml", kOwnPatterns, 0.0},
};

[[maybe_unused]] const bool registered = [] {
  for (const Scenario& scenario : kOneGoal)
    benchmark::RegisterBenchmark((std::string("oneGoal/") + scenario.name).c_str(),
                                 [&](benchmark::State& state) { oneGoal(state, scenario); })
        ->Unit(benchmark::kMillisecond)
        ->Iterations(11);
  for (const Scenario& scenario : kManyGoals)
    benchmark::RegisterBenchmark((std::string("manyGoals/") + scenario.name).c_str(),
                                 [&](benchmark::State& state) { manyGoals(state, scenario); })
        ->Unit(benchmark::kMillisecond)
        ->Iterations(1);
  return true;
}();

}  // namespace
