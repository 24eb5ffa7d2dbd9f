// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Comparison of rules: replay on a drive, errors around changes, and when a rule has converged.
#include <catch2/catch.hpp>

#include <cmath>
#include <cstdio>
#include <fstream>
#include <iterator>
#include <sstream>

#include <unistd.h>

#include "tests/helpers.hpp"
#include "tests/tools/lab/missions/shipped_robot.hpp"
#include "tools/lab/missions/comparison_report.hpp"
#include "tools/lab/missions/mission_runner.hpp"
#include "tools/lab/missions/prediction_errors.hpp"

using namespace tread;
using namespace tread::missions;

namespace {

/// A mission from tarmac to grass whose only pattern ends at x = 1 m on tarmac and 0.8 m on grass,
/// give or take a centimetre; a rule that needs `needed` executions to learn the grass.
MissionResult inventedMission(uint64_t seed, int on_grass, int needed) {
  MissionResult result;
  result.seed = seed;
  for (int i = 0; i < 10 + on_grass; ++i) {
    ScoredExecution execution;
    execution.time = i;
    execution.pattern = "ahead";
    execution.surface = i < 10 ? "tarmac" : "grass";
    execution.measured = true;
    execution.path_length = 1.0;
    execution.turned = 0.1;
    const double noise = i % 2 == 0 ? 0.01 : -0.01;
    execution.measured_end = {(i < 10 ? 1.0 : 0.8) + noise, 0.0, 2.0 * noise};
    const bool knows = i < 10 || i >= 10 + needed;
    execution.error_position = knows ? 0.01 : 0.2;
    execution.error_yaw = knows ? -0.02 : -0.3;
    result.executions.push_back(execution);
  }
  result.crossings.push_back({9.5, "tarmac", "grass"});
  return result;
}

std::vector<MissionResult> inventedMissions(int needed) {
  std::vector<MissionResult> results;
  for (uint64_t seed = 1; seed <= 12; ++seed)
    results.push_back(inventedMission(seed, seed % 3 == 0 ? 8 : 20, needed));
  return results;
}

Omniscient omniscientOf(const std::vector<MissionResult>& results) {
  Omniscient omniscient;
  for (const MissionResult& result : results) omniscient.add(result);
  return omniscient;
}

using tread::testing::contentOf;

}  // namespace

TEST_CASE("a shadow of the driving rule predicts what the drive predicted, others differ") {
  MissionOptions options;
  options.rule = "collective";
  options.shadows = {"off", "collective", "multi_model"};
  const MissionRun run = runMission(teodor(), 22, options);
  REQUIRE(run.result.shadow_rules == options.shadows);
  int measured = 0, as_driven = 0, off_differs = 0, bank_differs = 0;
  for (const ScoredExecution& execution : run.result.executions) {
    if (!execution.measured) {
      CHECK(execution.by_rule.empty());
      continue;
    }
    REQUIRE(execution.by_rule.size() == 3);
    ++measured;
    const auto& [off, collective, bank] =
        std::tie(execution.by_rule[0], execution.by_rule[1], execution.by_rule[2]);
    as_driven += std::abs(collective.position - execution.error_position) < 1e-12 ? 1 : 0;
    off_differs += off.position != collective.position ? 1 : 0;
    bank_differs += bank.position != collective.position ? 1 : 0;
  }
  CAPTURE(measured, as_driven);
  CHECK(measured > 15);
  CHECK(as_driven >= measured - 1);
  CHECK(off_differs >= measured - 5);
  CHECK(bank_differs >= measured - 5);

  // Shadow rules do not influence the drive.
  options.shadows.clear();
  const MissionRun alone = runMission(teodor(), 22, options);
  REQUIRE(alone.result.executions.size() == run.result.executions.size());
  CHECK(alone.result.time == run.result.time);
  CHECK(alone.result.distance == run.result.distance);
}

TEST_CASE("errors around changes count the last five before, three after, and the fifth on") {
  const std::vector<MissionResult> results = inventedMissions(2);
  const ErrorsAroundChanges errors = errorsAroundChanges(results, errorAsDriven());
  CHECK(errors.before.count == 12 * 5);
  CHECK(errors.before.position == Approx(0.01));
  CHECK(errors.after.count == 12 * 3);
  CHECK(errors.after.position == Approx((2 * 0.2 + 0.01) / 3));
  CHECK(errors.after.yaw == Approx((2 * 0.3 + 0.02) / 3));
  CHECK(errors.after.yaw_per_rad == Approx((2 * 0.3 + 0.02) / 3 / 0.1));
  CHECK(errors.first.position == Approx(0.2));
  CHECK(errors.next.yaw == Approx((0.3 + 0.02) / 2));
  CHECK(errors.settled.count == 8 * 11 + 4 * 4);
  CHECK(errors.settled.position_per_m == Approx(0.01));
  CHECK(meanErrorOf(results, errorAsDriven()).count == 12 * 10 + 8 * 20 + 4 * 8);
  CHECK(meanErrorOf(results, errorByRule(0)).count == 0);
}

TEST_CASE("a rule has settled after as many executions as it needed to know the new surface") {
  for (const int needed : {0, 3}) {
    CAPTURE(needed);
    const std::vector<MissionResult> results = inventedMissions(needed);
    const Settling settling = settlingOf(results, errorAsDriven(), omniscientOf(results));
    CHECK(settling.missions == 12);
    CHECK(settling.changes == 12);
    CHECK(settling.position == needed);
    CHECK(settling.yaw == needed);
    CHECK(settling.both == needed);
    REQUIRE(settling.position_ratio.size() > static_cast<size_t>(needed));
    CHECK(settling.position_ratio.at(static_cast<size_t>(needed)) == Approx(1.0).epsilon(0.02));
    if (needed > 0) CHECK(settling.position_ratio.front() > 5.0);
  }
  const std::vector<MissionResult> never = inventedMissions(20);
  const Settling settling = settlingOf(never, errorAsDriven(), omniscientOf(never));
  CHECK(std::isinf(settling.position));
  CHECK(settlingOf(never, errorAsDriven(), omniscientOf(never), Met::kFirst).changes == 12);
  CHECK(settlingOf(never, errorAsDriven(), omniscientOf(never), Met::kBefore).changes == 0);
}

TEST_CASE("the omniscient set is recorded in other worlds only") {
  const std::vector<MissionResult> results = inventedMissions(0);
  const ScoredExecution& execution = results[0].executions[0];
  Omniscient alone;
  alone.add(results[0]);
  CHECK_FALSE(alone.errorOf(execution, results[0].seed));
  alone.add(results[1]);
  const auto error = alone.errorOf(execution, results[0].seed);
  REQUIRE(error);
  CHECK(error->position == Approx(0.01));
  CHECK(error->yaw == Approx(0.02));
}

TEST_CASE("the median of times counts those that were not seen to the end as not yet") {
  CHECK(medianTime({{1, true}, {2, true}, {3, true}}) == 2.0);
  CHECK(medianTime({{1, false}, {1, false}, {4, true}}) == 4.0);
  CHECK(medianTime({{0, true}, {5, false}, {5, false}, {9, true}}) == 9.0);
  CHECK(std::isinf(medianTime({{1, true}, {5, false}, {5, false}})));
  CHECK(std::isinf(medianTime({})));
}

TEST_CASE("a comparison says in text and in JSON what each rule did") {
  RuleComparison comparison;
  for (const char* rule : {"collective", "off"}) {
    MissionBatch batch;
    batch.rule = rule;
    batch.results = inventedMissions(batch.rule == "off" ? 20 : 3);
    comparison.batches.push_back(batch);
  }
  for (MissionResult& result : comparison.batches.front().results) {
    result.shadow_rules = {"collective", "off"};
    for (ScoredExecution& execution : result.executions)
      execution.by_rule = {{execution.error_position, execution.error_yaw}, {0.2, 0.3}};
  }
  std::ostringstream text;
  printComparison(text, comparison);
  CHECK(text.str().find("12 missions each: arrived ") == 0);
  for (const char* words :
       {"closes of the way from off to omniscient", "collective 100 % (yaw 100 %)",
        "the same worlds", "those of the drives with collective", "omniscient", "the 1st after it",
        "2nd, 3rd after it", "1..3 after it", "never"})
    CHECK(text.str().find(words) != std::string::npos);
  const std::string path = "test_comparison_" + std::to_string(getpid()) + ".json";
  writeComparison(path, comparison);
  const std::string json = contentOf(path);
  std::remove(path.c_str());
  for (const char* key : {"same_worlds", "same_executions", "omniscient", "median_both", "after_1",
                          "after_2_to_3", "after_1_to_3", "settled_5_to_15", "batches"})
    CHECK(json.find('"' + std::string(key) + "\":") != std::string::npos);
  CHECK(json.find("\"median_position\": null") != std::string::npos);
  CHECK_THROWS_WITH(writeComparison("/nowhere/report.json", comparison),
                    Catch::Contains("/nowhere/report.json"));
}

TEST_CASE("longer missions keep each surface longer") {
  const MissionWorld usual = makeMissionWorld(5, {0.65, 0.65, 0.34});
  const MissionWorld longer = makeMissionWorld(5, {0.65, 0.65, 0.34}, 75.0);
  CHECK(longer.straight_line == Approx(3.0 * usual.straight_line));
  CHECK(longer.straight_line >= 75.0);
  CHECK_FALSE(sim::worldFault(longer.description));
}
