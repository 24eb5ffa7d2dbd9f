// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// A newer pattern set while the robot drives with the old one.
#include <catch2/catch.hpp>

#include <algorithm>

#include "tests/planner/kit/policy_rig.hpp"

using namespace tread;
using namespace tread::planner;
using namespace tread::planner::testkit;

TEST_CASE("A newer set is planned with in the next cycle, and what runs keeps its version") {
  Rig rig;
  rig.run(4.0);
  REQUIRE(rig.speed() > 0.2);
  PatternSetContent content = samplePatterns(2, 1.1).content();
  std::string why;
  const int64_t version = rig.supervisor().program().running().set->version();
  REQUIRE(rig.supervisor().takeSet(*PatternSet::make(content, why)));
  const Decision decision = rig.run(0.05);
  CHECK(decision.planned);
  CHECK(decision.report.set_version == content.version);
  CHECK(rig.supervisor().program().running().set->version() == version);
  CHECK(rig.supervisor().counters().at("cycles driven until a plan with the newest set") == 1);
  CHECK(rig.supervisor().counters().at("sets taken") == 2);
}

TEST_CASE("A set with other commands for what is under way waits until that has ended") {
  const auto spoil = [](PatternSetContent& content, int id, const std::string& how) {
    for (MotionPattern& pattern : content.patterns) {
      if (pattern.id != id) continue;
      if (how == "commands") pattern.commands.back()[0] -= 0.01;
    }
    if (how == "gone")
      content.patterns.erase(
          std::find_if(content.patterns.begin(), content.patterns.end(),
                       [&](const MotionPattern& pattern) { return pattern.id == id; }));
    if (how == "period") content.period_us += 1000;
  };
  const auto how = GENERATE(as<std::string>{}, "commands", "gone", "period");
  const bool spoil_next = GENERATE(false, true);
  CAPTURE(how, spoil_next);
  Rig rig;
  rig.run(4.0);
  Supervisor& supervisor = rig.supervisor();
  while (supervisor.program().next().empty()) rig.run(0.05);
  PatternSetContent content = samplePatterns(2).content();
  const int id = spoil_next ? rig.next().id : rig.running().id;
  spoil(content, id, how);
  std::string why;
  const auto set = PatternSet::make(content, why);
  INFO(why);
  REQUIRE(set);
  REQUIRE_FALSE(supervisor.takeSet(*set));
  CHECK_THAT(supervisor.setRefusal(), Catch::Contains("version 2"));
  CHECK_THAT(supervisor.setRefusal(), Catch::Contains("pattern " + std::to_string(id)));
  rig.run(0.05);
  CHECK(supervisor.program().running().set->version() == 1);
  // Without a goal the vehicle comes to rest: nothing is running, and the set is accepted.
  rig.inputs().goal.reset();
  rig.run(8.0);
  CHECK(rig.speed() < 0.05);
  CHECK(supervisor.setRefusal().empty());
  rig.inputs().goal = Goal{2, {12.0, 3.0, 0.0}, 0.5, 4.0};
  const Decision decision = rig.run(2.0);
  CHECK(decision.report.set_version == 2);
  CHECK(supervisor.program().running().set->version() == 2);
}

TEST_CASE("A set that cannot be driven with is not taken while something runs") {
  Rig rig;
  rig.run(4.0);
  // The same names, but no class at rest.
  PatternSetContent content = samplePatterns(2).content();
  for (MotionClass& motion_class : content.classes) motion_class.twist.v_x += 0.05;
  std::string why;
  const auto set = PatternSet::make(content, why);
  INFO(why);
  REQUIRE(set);
  CHECK_FALSE(rig.supervisor().takeSet(*set));
  CHECK_THAT(rig.supervisor().setRefusal(), Catch::Contains("version 2 waits"));
  rig.run(2.0);
  CHECK(rig.speed() > 0.2);
  CHECK(rig.supervisor().program().running().set->version() == 1);
}
