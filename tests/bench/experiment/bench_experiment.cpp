// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <benchmark/benchmark.h>

#include <algorithm>
#include <chrono>
#include <cstring>

#include "tools/lab/experiment/trials.hpp"

namespace {

using namespace tread;
using namespace tread::experiment;

constexpr int64_t kRepetitions = 500;

// The shape of the paper's experiment: five patterns of one second, two surfaces.
const char* const kWorld = R"(kind: transitions
name: bench
vehicle: {full_speed: 1.1, gauge: 0.6, lag: 0.15}
recordings: 300
noise: {position: 0.003, yaw: 0.001}
sequences: [{patterns: [left, left, right]}]
patterns:
  - {name: straight, commands: [[1, 1, 20]]}
  - {name: left, commands: [[0.8, 1, 20]]}
  - {name: right, commands: [[1, 0.8, 20]]}
  - {name: hard_left, commands: [[0.55, 1, 20]]}
  - {name: hard_right, commands: [[1, 0.55, 20]]}
surfaces:
  - {name: firm, spread: {forward: 0.015, yaw: 0.04, crab: 0.05}}
  - {name: soft, forward_gain: 1.1, yaw_gain: 1.3, spread: {forward: 0.04, yaw: 0.08, crab: 0.015}}
)";

const std::vector<TrialGround>& grounds() {
  static const std::vector<TrialGround> both = [] {
    std::vector<std::string> notes;
    return groundsOf(record(parseTransitionWorld(kWorld, "bench"), 1), notes);
  }();
  return both;
}

/// Nanoseconds to copy the numbers of the set once: the least cost of any rule that touches all of
/// them.
double copyTime() {
  size_t numbers = 0;
  for (const MotionPattern& pattern : grounds().front().averaged.patterns())
    numbers += 3 * pattern.trajectory.size();
  std::vector<double> from(numbers, 1.0), to(numbers);
  constexpr int kCopies = 200'000;
  double best = 1e9;
  for (int round = 0; round < 5; ++round) {
    const auto begun = std::chrono::steady_clock::now();
    for (int i = 0; i < kCopies; ++i) {
      std::memcpy(to.data(), from.data(), numbers * sizeof(double));
      benchmark::DoNotOptimize(to.data());
      benchmark::ClobberMemory();
    }
    const std::chrono::duration<double, std::nano> passed =
        std::chrono::steady_clock::now() - begun;
    best = std::min(best, passed.count() / kCopies);
  }
  return best;
}

/// One transition with one rule: a reset, three executions, two updates, twice in each repetition.
void transition(benchmark::State& state, const std::string& rule) {
  static const double copy = copyTime();
  const std::vector<Sequence> sequences{{1, 1, 2}, {2, 2, 1}};
  Methods methods({rule}, {}, grounds(), 0, 1, {});
  const TrialSite site{grounds()[0], grounds()[1], false, kRepetitions, 1};
  const auto begun = std::chrono::steady_clock::now();
  for (auto _ : state) benchmark::DoNotOptimize(driveSequences(methods, site, sequences, {}, {}));
  const std::chrono::duration<double, std::nano> passed = std::chrono::steady_clock::now() - begun;
  const double each =
      passed.count() / static_cast<double>(state.iterations()) / (6.0 * kRepetitions);
  state.counters["ns/execution"] = each;
  state.counters["over_copy"] = each / copy;
}

}  // namespace

int main(int argc, char** argv) {
  for (const std::string& rule : methodNames())
    benchmark::RegisterBenchmark(("transition/" + rule).c_str(), transition, rule)
        ->Unit(benchmark::kMicrosecond);
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
