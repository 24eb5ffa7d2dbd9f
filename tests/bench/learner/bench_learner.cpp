// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <benchmark/benchmark.h>
#include <time.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <numeric>
#include <random>

#include "common/vehicle/kernel.hpp"
#include "modules/learner/core/learner.hpp"
#include "modules/learner/core/rules/make_rule.hpp"

namespace {

using namespace tread;
using namespace tread::learner;

/// Processor time of this thread, independent of others [ns].
double now() {
  timespec time{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &time);
  return 1e9 * static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_nsec);
}

constexpr double kPeriod = 0.05;
constexpr size_t kSurfaces = 4;
constexpr size_t kStay = 40;  // executions before the surface changes

VehicleModel surface(size_t number) {
  VehicleModel model;
  model.full_speed = 1.1;
  model.gauge = 0.6;
  model.lag = 0.15;
  model.forward_gain = 1.0 + 0.1 * static_cast<double>(number);
  model.yaw_gain = 0.8 + 0.25 * static_cast<double>(number);
  model.spread = {0.02, 0.04, 0.02};
  return model;
}

/// A set of so many patterns, from straight to sharp turns on both sides.
PatternSet setOf(size_t patterns, size_t samples) {
  const VehicleModel model = surface(0);
  const TrackCommand full{1.0, 1.0};
  PatternSetContent content;
  content.name = "bench";
  content.period_us = 50'000;
  content.classes = {{"entry", steadyTwist(model, full), full}};
  for (size_t p = 0; p < patterns; ++p) {
    const double slow = 1.0 - 0.05 * static_cast<double>((p + 1) / 2);
    MotionPattern pattern;
    pattern.id = static_cast<int>(p) + 1;
    pattern.name = "p" + std::to_string(p);
    pattern.entry_class = pattern.exit_class = "entry";
    const std::vector<TrackCommand> commands(
        samples, p % 2 == 0 ? TrackCommand{slow, 1.0} : TrackCommand{1.0, slow});
    pattern.commands = commandsOf(commands);
    pattern.trajectory = simulate(model, commands, kPeriod, steadyEntry(model, full));
    content.patterns.push_back(std::move(pattern));
  }
  std::string why;
  const auto set = PatternSet::make(std::move(content), why);
  if (!set) {
    std::fprintf(stderr, "bench-learner: %s\n", why.c_str());
    std::exit(1);
  }
  return *set;
}

/// One execution for the learner.
struct Driven {
  size_t pattern = 0;
  Measurement measurement;
  std::vector<double> numbers;
  ConstTrajectory trajectory() const {
    return {numbers.data(), static_cast<Eigen::Index>(numbers.size() / 3), 3};
  }
};

/// Executions of all patterns on a sequence of surfaces; with `parts` half of them are incomplete.
std::vector<Driven> drives(const PatternSet& set, bool parts = false) {
  std::mt19937_64 random(1);
  std::vector<Driven> all;
  for (size_t s = 0; s < kSurfaces; ++s) {
    const VehicleModel model = surface(s);
    for (size_t i = 0; i < kStay; ++i) {
      Driven driven;
      driven.pattern = random() % set.patterns().size();
      const MotionPattern& pattern = set.patterns()[driven.pattern];
      driven.measurement.trajectory =
          simulate(model, tracksOf(pattern.commands), kPeriod, steadyEntry(model, {1.0, 1.0}),
                   drawNoise(model.spread, random));
      driven.measurement.covered = pattern.commands.size();
      if (parts && i % 2 == 1)
        driven.measurement.trajectory.resize(1 + random() % pattern.commands.size());
      fill(driven.measurement.trajectory, driven.numbers);
      all.push_back(std::move(driven));
    }
  }
  return all;
}

size_t numbersOf(const PatternSet& set) {
  size_t numbers = 0;
  for (const MotionPattern& pattern : set.patterns()) numbers += 3 * pattern.trajectory.size();
  return numbers;
}

/// Nanoseconds to copy the numbers of the set once: the least cost of any rule that touches all of
/// them.
double copyTime(const PatternSet& set) {
  const size_t numbers = numbersOf(set);
  std::vector<double> from(numbers, 1.0), to(numbers);
  constexpr int kCopies = 100'000;
  double best = 1e9;
  for (int round = 0; round < 5; ++round) {
    const double begun = now();
    for (int i = 0; i < kCopies; ++i) {
      std::memcpy(to.data(), from.data(), numbers * sizeof(double));
      benchmark::DoNotOptimize(to.data());
      benchmark::ClobberMemory();
    }
    best = std::min(best, (now() - begun) / kCopies);
  }
  return best;
}

RuleConfig configOf(Rule rule) {
  RuleConfig config;
  config.rule = rule;
  return config;
}

void putTimes(benchmark::State& state, std::vector<double> times) {
  std::sort(times.begin(), times.end());
  state.counters["median_us"] = times[times.size() / 2];
  state.counters["p95_us"] = times[times.size() * 95 / 100];
  state.counters["p99_us"] = times[times.size() * 99 / 100];
}

/// Learns one execution and predicts all patterns again; single times [us].
void update(benchmark::State& state, Rule name, size_t patterns, size_t samples, bool parts) {
  const PatternSet set = setOf(patterns, samples);
  const std::vector<Driven> driven = drives(set, parts);
  const double copy = copyTime(set);
  const auto rule = makeRule(configOf(name), set);
  std::vector<double> numbers(3 * samples);
  const Trajectory prediction(numbers.data(), static_cast<Eigen::Index>(samples), 3);
  RuleNote note;
  for (int round = 0; round < 3; ++round)
    for (const Driven& one : driven) rule->learn(one.pattern, one.trajectory(), note);
  std::vector<double> times;
  size_t i = 0;
  for (auto _ : state) {
    const Driven& one = driven[i++ % driven.size()];
    const double begun = now();
    rule->learn(one.pattern, one.trajectory(), note);
    for (size_t p = 0; p < patterns; ++p) {
      rule->predict(p, prediction);
      benchmark::DoNotOptimize(numbers.data());
      benchmark::ClobberMemory();
    }
    times.push_back(1e-3 * (now() - begun));
  }
  const double each =
      1e3 * std::accumulate(times.begin(), times.end(), 0.0) / static_cast<double>(times.size());
  state.counters["ns/pattern"] = each / static_cast<double>(patterns);
  state.counters["over_copy"] = each / copy;
  putTimes(state, std::move(times));
  if (rule->remembered() >= 0) state.counters["surfaces"] = rule->remembered();
}

/// A complete correction: learning, predictions, covariances, the new checked set. Single times
/// [us].
void correct(benchmark::State& state, Rule name, size_t patterns, size_t samples) {
  const PatternSet set = setOf(patterns, samples);
  const std::vector<Driven> driven = drives(set);
  Learner learner(configOf(name), set);
  int64_t utime = 0;
  const auto learn = [&](const Driven& one) {
    benchmark::DoNotOptimize(
        learner.learn(static_cast<int>(one.pattern) + 1, one.measurement, std::nullopt, ++utime));
  };
  for (int round = 0; round < 3; ++round)
    for (const Driven& one : driven) learn(one);
  std::vector<double> times;
  size_t i = 0;
  for (auto _ : state) {
    const double begun = now();
    learn(driven[i++ % driven.size()]);
    times.push_back(1e-3 * (now() - begun));
  }
  putTimes(state, std::move(times));
  if (learner.rule().remembered() >= 0) state.counters["surfaces"] = learner.rule().remembered();
}

void registerAll() {
  for (const auto& [patterns, samples] : {std::pair<size_t, size_t>{5, 20}, {15, 100}}) {
    const std::string shape = "/" + std::to_string(patterns) + "x" + std::to_string(samples);
    for (const Rule& rule : ruleNames())
      benchmark::RegisterBenchmark(
          ("update/" + rule + shape).c_str(),
          [rule, patterns = patterns, samples = samples](benchmark::State& state) {
            update(state, rule, patterns, samples, false);
          })
          ->Unit(benchmark::kMicrosecond);
  }
  for (const Rule& rule : ruleNames())
    if (makeRule(configOf(rule), setOf(1, 2))->learnsParts())
      benchmark::RegisterBenchmark(
          ("update_parts/" + rule + "/15x100").c_str(),
          [rule](benchmark::State& state) { update(state, rule, 15, 100, true); })
          ->Unit(benchmark::kMicrosecond);
  for (const Rule& rule : ruleNames())
    benchmark::RegisterBenchmark(("correct/" + rule + "/15x100").c_str(),
                                 [rule](benchmark::State& state) { correct(state, rule, 15, 100); })
        ->Unit(benchmark::kMicrosecond);
}

}  // namespace

int main(int argc, char** argv) {
  registerAll();
  benchmark::Initialize(&argc, argv);
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
