// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Pattern sets that arrive while the robot drives, and their reports in HEALTH.
#include <catch2/catch.hpp>

#include <map>
#include <string>

#include "tests/planner/kit/yard.hpp"

using namespace tread;
using namespace tread::planner;
using namespace tread::planner::testkit;

namespace {

void send(Yard& yard, const PatternSet& set) {
  int64_t seq = 1000 * set.version();
  for (pattern_set_part_t part : toMessages(set)) {
    part.seq = seq++;
    yard.bus.outside().publish(kPatternSet, part);
  }
}

std::map<std::string, int64_t> counters(const Yard& yard) {
  std::map<std::string, int64_t> all;
  for (const counter_t& counter : yard.health.counters) all[counter.counter_name] = counter.counted;
  return all;
}

void drive(Yard& yard) {
  yard.run(1.5);
  yard.sendGoal(14.0);
  yard.armAndGo();
  yard.run(3.0);
  REQUIRE(yard.robot().speed() > 0.5);
}

}  // namespace

TEST_CASE("A set swapped in while driving costs no cycle but those in which the next is frozen") {
  Yard yard;
  drive(yard);
  send(yard, samplePatterns(2, 1.05));
  yard.run(0.2);
  CHECK(yard.plan.set_version == 2);
  CHECK(yard.plan.plan_status == plan_t::PLAN_DRIVING);
  yard.run(1.2);
  std::map<std::string, int64_t> all = counters(yard);
  CHECK(all.at("pattern set version") == 2);
  CHECK(all.at("sets taken") == 2);
  CHECK(all.at("cycles driven until a plan with the newest set") <= 1 + 130 / 50);
  CHECK(all.count("longest swap of a set [us]") == 1);
  CHECK(yard.robot().aborted() == 0);
}

TEST_CASE("A set with other commands for what runs leaves the robot driving and HEALTH degraded") {
  Yard yard;
  drive(yard);
  PatternSetContent content = samplePatterns(2).content();
  for (MotionPattern& pattern : content.patterns)
    for (Command& command : pattern.commands) command[0] *= 0.99;
  std::string why;
  const auto set = PatternSet::make(content, why);
  INFO(why);
  REQUIRE(set);
  send(yard, *set);
  yard.run(1.2);
  CHECK(yard.plan.set_version == 1);
  CHECK(yard.plan.plan_status == plan_t::PLAN_DRIVING);
  CHECK(yard.health.health_state == health_t::HEALTH_DEGRADED);
  CHECK_THAT(yard.health.health_reason, Catch::Contains("PATTERN_SET version 2 waits"));
  // At the goal nothing is running.
  yard.run(25.0);
  CHECK(yard.plan.plan_status == plan_t::PLAN_ARRIVED);
  CHECK(yard.plan.set_version == 2);
  // The toy's learner still publishes version 1.
  CHECK_THAT(yard.health.health_reason, Catch::Contains("version 1 is published beside"));
  CHECK(yard.robot().aborted() == 0);
}
