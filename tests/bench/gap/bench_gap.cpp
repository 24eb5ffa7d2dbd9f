// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <benchmark/benchmark.h>
#include <time.h>

#include <string>
#include <utility>
#include <vector>

#include "modules/identification/core/discovery.hpp"
#include "tests/identification/synthetic_drive.hpp"

// Computing time of `tread-gap find` between log and report, for ten minutes of driving with one
// thread: the tests of the whole catalogue, refits, pruning, nested halves, adequacy and residual
// maps. Reading logs and writing reports are excluded. The drive and its hidden effect are
// constant, so the work is, too. `simulations` is that time divided by the time of one simulation
// and prediction of the same drive by the nominal model, in the same process: it is comparable
// between machines. `cpu_s` is the processor time on this one.

namespace {

using namespace tread;
using namespace tread::gap;

using Hidden = std::vector<std::pair<std::string, double>>;

constexpr double kSeconds = 600.0;
constexpr uint64_t kSeed = 7;
constexpr int kReference = 100;  // predictions averaged for the reference

/// Processor time of this process, independent of others [s].
double now() {
  timespec time{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &time);
  return static_cast<double>(time.tv_sec) + 1e-9 * static_cast<double>(time.tv_nsec);
}

GapTask taskOf(const Hidden& hidden) {
  ModelDocument truth = syntheticVehicle();
  for (const auto& [path, value] : hidden) *findParameter(truth, path) = value;
  GapTask task;
  task.model = syntheticVehicle();
  task.seed = kSeed;
  task.train.push_back(syntheticDrive(truth, kSeconds, kSeed));
  return task;
}

/// Seconds for one simulation and prediction of the drive by the nominal model.
double predictionTime(const GapTask& task) {
  const Observations data(task.train, {});
  benchmark::DoNotOptimize(data.predict(task.model).data());
  const double begun = now();
  for (int i = 0; i < kReference; ++i) benchmark::DoNotOptimize(data.predict(task.model).data());
  return (now() - begun) / kReference;
}

void find(benchmark::State& state, const Hidden& hidden) {
  const GapTask task = taskOf(hidden);
  const double prediction = predictionTime(task);
  const Progress silent = [](const std::string&) {};
  std::string names;
  double spent = 0.0;
  for (auto _ : state) {
    const double begun = now();
    const GapFinding finding = findGap(task, silent);
    spent += now() - begun;
    names = verdictName(finding.verdict);
    for (const FoundEffect& effect : finding.identified.effects) names += " " + effect.name;
  }
  const double each = spent / static_cast<double>(state.iterations());
  state.counters["cpu_s"] = each;
  state.counters["simulations"] = each / prediction;
  state.counters["one_ms"] = 1e3 * prediction;
  state.SetLabel(names);
}

void findOne(benchmark::State& state) {
  find(state, {{"motor_deadband.speed", 0.1}});
}

void findThree(benchmark::State& state) {
  find(state, {{"track_asymmetry.share", 0.05},
               {"centrifugal_drift.time", 0.2},
               {"motor_deadband.speed", 0.1}});
}

BENCHMARK(findOne)->Name("find/one_hidden")->Unit(benchmark::kSecond)->Iterations(1);
BENCHMARK(findThree)->Name("find/three_hidden")->Unit(benchmark::kSecond)->Iterations(1);

}  // namespace
