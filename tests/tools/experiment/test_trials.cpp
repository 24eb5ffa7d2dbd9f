// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "tests/helpers.hpp"
#include "tests/tools/experiment/counted_new.hpp"
#include "tests/tools/experiment/small_world.hpp"

namespace tread::experiment {
namespace {

using namespace testing;
using tread::testing::effort;

/// Everything that an experiment puts into files.
std::string filesOf(const std::vector<Ground>& grounds, const ExperimentSettings& settings) {
  const Tables tables = tablesOf(runExperiment(grounds, settings, {}), settings, grounds);
  std::string text;
  for (const TableFile& file : tableFiles()) text += csvOf(tables, file);
  return text;
}

/// What learning off errs in truth: every recording is as likely as any other.
double expectedError(const Ground& from, const Ground& to, const std::vector<Sequence>& sequences) {
  double error = 0.0, metres = 0.0;
  for (const Sequence& sequence : sequences)
    for (const size_t pattern : sequence) {
      const Executions& executions = to.executions[pattern];
      for (size_t i = 0; i < executions.size(); ++i) {
        const ExecutionEnd& end = executions.endOf(i);
        error += (from.averaged_ends[pattern].position() - end.pose.position()).norm();
        metres += end.metres;
      }
    }
  return error / metres;
}

}  // namespace

TEST_CASE("the number of threads has no influence on any byte, the seed has") {
  const std::vector<Ground> grounds = groundsOfText(kSmallWorld);
  ExperimentSettings settings = smallSettings();
  const std::string one = filesOf(grounds, settings);
  settings.threads = 3;
  CHECK(filesOf(grounds, settings) == one);
  settings.seed = 2;
  CHECK(filesOf(grounds, settings) != one);
}

TEST_CASE("progress tells every part once") {
  ExperimentSettings settings = smallSettings();
  settings.repetitions = 1;
  settings.threads = 3;
  size_t calls = 0, parts = 0;
  runExperiment(groundsOfText(kSmallWorld), settings, [&](size_t done, size_t all) {
    CHECK(done == ++calls);
    parts = all;
  });
  CHECK(calls == parts);
  CHECK(calls > 1);
}

TEST_CASE("every rule of the learner takes part, and others do not disturb it") {
  const std::vector<Ground> grounds = groundsOfText(kSmallWorld);
  ExperimentSettings settings = smallSettings();
  settings.repetitions = effort(100);
  settings.excitation = 40;
  settings.rules = methodNames();
  const Tables all = tablesOf(runExperiment(grounds, settings, {}), settings, grounds);
  settings.rules = {"collective", "single"};
  const Tables two = tablesOf(runExperiment(grounds, settings, {}), settings, grounds);
  for (const Row& row : two.errors) {
    const Row* same = find(all.errors, row.from, row.to, row.quantity, row.rule);
    REQUIRE(same != nullptr);
    CHECK(same->estimate.value == row.estimate.value);
  }
  for (const Row& row : all.errors) {
    INFO(row.rule << " " << row.from << " " << row.to);
    CHECK(std::isfinite(row.estimate.value));
  }
}

TEST_CASE("the interval of a table covers the error that all recordings together have") {
  const std::vector<Ground> grounds = groundsOfText(kSmallWorld);
  ExperimentSettings settings = smallSettings();
  settings.rules = {"off"};
  const double truth = expectedError(grounds[0], grounds[1], settings.sequences);
  const int experiments = effort(300);
  int covered = 0;
  for (int i = 0; i < experiments; ++i) {
    Methods methods(settings.rules, settings.config, grounds, 0, 1, settings.excitation, 0);
    const TrialSite site{grounds[0], grounds[1], false, 200, static_cast<uint64_t>(i)};
    const Estimate estimate =
        driveSequences(methods, site, settings.sequences, {}, {}).errors.position.error(0);
    if (estimate.low <= truth && truth <= estimate.high) ++covered;
  }
  CHECK(covered >= 0.97 * experiments);
}

TEST_CASE("repetitions allocate nothing") {
  const std::vector<Ground> grounds = groundsOfText(kSmallWorld);
  const ExperimentSettings settings = smallSettings();
  for (const std::string& rule : methodNames()) {
    // They may close a block of executions; see below.
    if (rule == "bank" || rule == kBankUnseen) continue;
    for (const bool change_inside : {false, true}) {
      const auto allocationsOf = [&](int64_t repetitions) {
        Methods methods({rule}, settings.config, grounds, 0, 1, settings.excitation, 0);
        const TrialSite site{grounds[0], grounds[1], change_inside, repetitions, 1};
        const std::size_t before = allocations();
        driveSequences(methods, site, settings.sequences, {}, {});
        return allocations() - before;
      };
      INFO(rule);
      CHECK(allocationsOf(3) == allocationsOf(300));
    }
  }
}

TEST_CASE("the bank allocates nothing but when it judges a block of executions") {
  const std::vector<Ground> grounds = groundsOfText(kSmallWorld);
  learner::RuleConfig config;
  config.rule = "bank";
  const auto rule = learner::makeRule(config, grounds[0].averaged);
  driveExcitation(*rule, grounds, {0, grounds.size(), 50}, 1);
  const int executions = 400;
  int64_t judged = 0, since = config.bank.settled_after;
  for (int i = 0; i < executions; ++i) {
    const auto pattern = static_cast<size_t>(i % 3);
    const Ground& ground = grounds[static_cast<size_t>(i / 100 % 2)];
    const auto measured = ground.executions[pattern].of(static_cast<size_t>(i % 40));
    learner::RuleNote note;
    const std::size_t before = allocations();
    rule->learn(pattern, measured, note);
    ++since;
    if (allocations() == before) continue;
    CHECK((judged == 0 || since >= config.bank.settled_after));
    ++judged;
    since = 0;
  }
  CHECK(judged <= executions / config.bank.settled_after + 1);
}

TEST_CASE("twice as long commands make patterns twice as long") {
  const TransitionWorld world = parseTransitionWorld(kSmallWorld, "small.yaml");
  const recordings::PatternRecordings recorded = record(world, 1, 2);
  CHECK(recorded.patterns.patterns()[1].commands.size() == 20);
  CHECK(recorded.surfaces[0].executions[0][0].size() == 20);
  CHECK(recorded.surfaces[0].executions[0][0].back().x == Approx(1.1 * 1.1).epsilon(0.1));
}

}  // namespace tread::experiment
