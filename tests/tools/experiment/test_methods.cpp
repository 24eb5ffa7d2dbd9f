// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// What the bank meets before a transition, and what it is good for afterwards.
#include <catch2/catch.hpp>

#include "tests/tools/experiment/small_world.hpp"

namespace tread::experiment {
namespace {

using namespace testing;

}  // namespace

TEST_CASE(
    "an excitation run leaves out what is unseen, ends at home and lists what the bank holds") {
  const std::vector<Ground> grounds = groundsOfText(kSmallWorld);
  const size_t none = grounds.size();
  const ExcitationRun run = excitationOfBank({}, grounds, {0, none, 60}, 1);
  REQUIRE(run.segments.size() == 2);
  CHECK(run.segments[0].surface == "road");
  CHECK(run.segments[1].surface == "ice");
  CHECK(run.segments[1].executions == 60);
  REQUIRE(run.stored.size() == 2);
  // The set is that of ice; on road the vehicle turns more.
  const size_t road = run.explains[0] == std::vector<std::string>{"road"} ? 0 : 1;
  CHECK(run.explains[1 - road] == std::vector<std::string>{"ice"});
  const auto& x = run.stored[road].x;
  CHECK(x[learner::TwistCorrection::kYaw] > 0.1);
  CHECK(textOfExcitation({run}, grounds[0].averaged).find("stored after") != std::string::npos);
  CHECK(excitationOfBank({}, grounds, {0, 1, 60}, 1).segments.size() == 1);
  CHECK(excitationOfBank({}, grounds, {0, 0, 60}, 1).segments.front().surface == "road");
}

TEST_CASE("a bank that knows both surfaces errs less after a change than one that is empty") {
  const std::vector<Ground> grounds = groundsOfText(kSmallWorld);
  ExperimentSettings settings = smallSettings();
  settings.rules = {"bank", kBankEmpty};
  settings.excitation = 60;
  for (const TransitionErrors& transition : runExperiment(grounds, settings, {}).transitions) {
    const RatioMoments& yaw = transition.sequences.errors.orientation;
    CHECK(yaw.error(0).value < yaw.error(1).value);
  }
}

TEST_CASE("collective scaling widens what is never executed, the default rule does not") {
  std::string world = kSmallWorld;
  const std::string straight = "  - {name: straight, commands: [[1, 1, 10]]}\n";
  world.replace(world.find(straight), straight.size(),
                straight + "  - {name: hard, commands: [[0.5, 1, 10]]}\n");
  const std::vector<Ground> grounds = groundsOfText(world);
  ExperimentSettings settings = smallSettings();
  settings.sequences = {{2, 2, 3}, {3, 3, 2}};
  settings.rules = {"collective", "telescoping", "bank"};
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
  setting.rules = methodNames();
  const auto groups = columnGroups(setting);
  CHECK(groups[0] == std::vector<std::string>{"off", "single", "collective", kOmniscient});
  size_t columns = 0;
  for (const auto& group : groups) {
    CHECK(group.size() <= 4);
    columns += group.size();
  }
  CHECK(columns == setting.rules.size());
  setting.surfaces = {"ice", "road"};
  CHECK(columnGroups(setting).size() == 1);
}

}  // namespace tread::experiment
