// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The promises of the default learning rule in the closed loop, with few missions;
// tests/bench/RESULTS.md has the figures of a hundred missions.
#include <catch2/catch.hpp>

#include "tests/tools/lab/missions/shipped_robot.hpp"
#include "tools/lab/missions/mission_runner.hpp"
#include "tools/lab/missions/prediction_errors.hpp"

using namespace tread;
using namespace tread::missions;

TEST_CASE("the default rule predicts as well as none just after a change of ground, then better") {
  const learner::Rule rule = teodor().learner.rule.rule;
  REQUIRE(rule == "multi_model");
  MissionOptions options;
  options.rule = "off";
  options.shadows = {"off", rule};
  std::vector<MissionResult> results;
  for (uint64_t seed = 90001; seed <= 90008; ++seed)
    results.push_back(runMission(teodor(), seed, options).result);
  const ErrorsAroundChanges off = errorsAroundChanges(results, errorByRule(0));
  const ErrorsAroundChanges learned = errorsAroundChanges(results, errorByRule(1));
  const MeanError off_all = meanErrorOf(results, errorByRule(0));
  const MeanError learned_all = meanErrorOf(results, errorByRule(1));
  CAPTURE(off.after.count, off.after.position, learned.after.position, off.after.yaw,
          learned.after.yaw, off.settled.position, learned.settled.position, off.settled.yaw,
          learned.settled.yaw, off_all.position, learned_all.position);
  REQUIRE(off.after.count > 30);
  CHECK(learned.after.position < 1.15 * off.after.position);
  CHECK(learned.after.yaw < 1.15 * off.after.yaw);
  CHECK(learned.settled.position < 0.95 * off.settled.position);
  CHECK(learned.settled.yaw < 0.85 * off.settled.yaw);
  CHECK(learned_all.position < 0.95 * off_all.position);
  CHECK(learned_all.yaw < 0.90 * off_all.yaw);
}
