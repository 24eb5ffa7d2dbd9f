// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Methods, their driving before a transition, and its benefit afterwards.
#include <algorithm>
#include <set>

#include <catch2/catch.hpp>

#include "tests/tools/lab/experiment/small_world.hpp"
#include "tools/lab/experiment/text_tables.hpp"

namespace tread::experiment {
namespace {

using namespace testing;

}  // namespace

TEST_CASE("a method is a rule with a history, the same histories for every rule") {
  CHECK(methodOf("single")->history == TrialHistory::kNone);
  CHECK(methodOf("multi_model_unmet")->rule == "multi_model");
  CHECK(methodOf("multi_model_unmet")->history == TrialHistory::kUnmet);
  CHECK(methodOf(kOmniscient)->rule.empty());
  for (const char* none : {"", "off_home", "omniscient_home", "single_", "_home", "magic"})
    CHECK_FALSE(methodOf(none));
  CHECK(methodOf("rls3_home")->rule == "rls3");
  CHECK(methodNames().size() == 4 * (learnerNames().size() - 1) + 2);
  for (const std::string& name : defaultMethods()) CHECK(methodOf(name));
}

TEST_CASE(
    "an excitation run drives the surfaces of its history, from where the transition starts") {
  std::mt19937_64 random(1);
  using Surfaces = std::vector<size_t>;
  const auto order = [&](TrialHistory history, size_t from, size_t to) {
    return excitationOrder(history, 4, from, to, random);
  };
  CHECK(order(TrialHistory::kNone, 0, 1).empty());
  CHECK(order(TrialHistory::kHome, 0, 1) == Surfaces{0});
  std::set<Surfaces> orders;
  for (int i = 0; i < 50; ++i) {
    Surfaces unmet = order(TrialHistory::kUnmet, 0, 1),
             all = order(TrialHistory::kRemembered, 0, 1);
    orders.insert(all);
    CHECK((unmet == Surfaces{2, 3, 0} || unmet == Surfaces{3, 2, 0}));
    CHECK(all.back() == 0);
    std::sort(all.begin(), all.end());
    CHECK(all == Surfaces{0, 1, 2, 3});
    CHECK(order(TrialHistory::kUnmet, 2, 2).size() == 3);
  }
  CHECK(orders.size() == 6);
  CHECK(order(TrialHistory::kHome, 2, 2) == Surfaces{2});
}

TEST_CASE("every rule is what it was without a history, and has learned with one") {
  const std::vector<TrialGround> grounds = groundsOfText(kSmallWorld);
  for (const std::string& rule : learnerNames()) {
    if (rule == "off" || rule == "basis") continue;  // one surface is not enough for a basis
    const std::vector<std::string> names{rule, rule + "_home", rule + "_remembered"};
    const Methods methods(names, {}, grounds, 0, 1, {});
    const Pose2& shipped = grounds[0].averaged_ends[1];
    INFO(rule);
    CHECK(methods.predictEnd(0, 1).yaw == shipped.yaw);
    CHECK(methods.predictEnd(1, 1).yaw != shipped.yaw);
    CHECK(methods.predictEnd(2, 1).yaw != methods.predictEnd(1, 1).yaw);
    if (rule == "constant" || rule == "gp") continue;  // they keep old executions
    // The last surface is the one from which the transition starts.
    const double away = grounds[1].averaged_ends[1].yaw;
    CHECK(std::abs(methods.predictEnd(2, 1).yaw - shipped.yaw) <
          0.3 * std::abs(away - shipped.yaw));
  }
}

TEST_CASE("no recording that is tested was averaged or driven before") {
  recordings::PatternRecordings recorded = record(parseTransitionWorld(kSmallWorld, "small"), 1);
  const Pose2 odd = recorded.surfaces[0].executions[1][0].back();
  std::vector<std::string> notes;
  const std::vector<TrialGround> before = groundsOf(recorded, notes);
  CHECK(notes.empty());
  std::set<double> known, tested;
  for (size_t p = 0; p < 3; ++p) {
    for (size_t i = 0; i < before[0].known[p].size(); ++i)
      known.insert(before[0].known[p].endOf(i).pose.x);
    for (size_t i = 0; i < before[0].tests[p].size(); ++i)
      tested.insert(before[0].tests[p].endOf(i).pose.x);
    CHECK(before[0].known[p].size() == before[0].tests[p].size());
  }
  CHECK(known.count(odd.x) == 1);
  for (const double x : tested) CHECK(known.count(x) == 0);
  // A different test recording changes no average; the neighbours 2 and 3 are tests.
  for (size_t i : {2U, 3U})
    for (Pose2& pose : recorded.surfaces[0].executions[1][i]) pose.x *= 1.01;
  const std::vector<TrialGround> after = groundsOf(recorded, notes);
  CHECK(after[0].averaged_ends[1].x == before[0].averaged_ends[1].x);
  CHECK(after[0].tests[1].endOf(0).pose.x != before[0].tests[1].endOf(0).pose.x);
}

TEST_CASE("few recordings are told, too few are refused") {
  recordings::PatternRecordings recorded = record(parseTransitionWorld(kSmallWorld, "small"), 1);
  std::vector<std::string> notes;
  recorded.surfaces[1].executions[2].resize(9);
  groundsOf(recorded, notes);
  REQUIRE(notes.size() == 1);
  CHECK(notes[0].find("road: few recordings, 9 of a pattern") == 0);
  recorded.surfaces[1].executions[2].resize(7);
  CHECK_THROWS_WITH(groundsOf(recorded, notes), Catch::Contains("at least 8"));
}

TEST_CASE("a rule that met both surfaces errs less after a change than one that met one") {
  const std::vector<TrialGround> grounds = groundsOfText(kSmallWorld);
  ExperimentSettings settings = smallSettings();
  settings.rules = {"multi_model_remembered", "multi_model_home"};
  for (const TransitionErrors& transition : runExperiment(grounds, settings, {}).transitions) {
    const RatioMoments& yaw = transition.sequences.errors.orientation;
    CHECK(yaw.error(0).value < yaw.error(1).value);
    CHECK(transition.remembered[0] > transition.remembered[1]);
  }
}

TEST_CASE("collective scaling widens what is never executed, the default rule does not") {
  std::string world = kSmallWorld;
  const std::string straight = "  - {name: straight, commands: [[1, 1, 10]]}\n";
  world.replace(world.find(straight), straight.size(),
                straight + "  - {name: hard, commands: [[0.5, 1, 10]]}\n");
  const std::vector<TrialGround> grounds = groundsOfText(world);
  ExperimentSettings settings = smallSettings();
  settings.sequences = {{2, 2, 3}, {3, 3, 2}};
  settings.rules = {"collective", "telescoping", "multi_model"};
  settings.repetitions = 2;
  CHECK(neverExecuted(grounds[0], settings.sequences) == size_t{1});
  CHECK_FALSE(neverExecuted(grounds[0], {{0, 1, 2, 3}}));
  const auto drift = runExperiment(grounds, settings, {}).drift;
  REQUIRE(drift.size() == 3);
  REQUIRE(drift[0].size() == 301);
  CHECK(drift[0].front() == 1.0);
  CHECK(drift[0].back() > 1.5);
  CHECK(drift[1].back() == Approx(1.0).margin(0.1));
  CHECK(drift[2].back() == Approx(1.0).margin(0.1));
}

TEST_CASE("tables of many rules stay narrow enough to read") {
  Setting setting;
  setting.surfaces = {"cinder", "tarmac", "grass", "gravel"};
  setting.rules = defaultMethods();
  const auto groups = columnGroups(setting);
  CHECK(groups[0] == std::vector<std::string>{"off", "single", "collective", kOmniscient});
  size_t columns = 0;
  for (const auto& group : groups) {
    CHECK(group.size() <= 4);
    columns += group.size();
  }
  CHECK(columns == setting.rules.size());
  setting.surfaces = {"ice", "road"};
  setting.rules.resize(9);
  CHECK(columnGroups(setting).size() == 1);
}

}  // namespace tread::experiment
