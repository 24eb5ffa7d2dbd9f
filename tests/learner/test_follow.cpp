// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Learning from an execution before its end, and from a stopped one.
#include <catch2/catch.hpp>

#include <cmath>
#include <set>

#include "modules/learner/core/state_text.hpp"
#include "tests/learner/bench.hpp"

using namespace tread;
using namespace tread::learner;
using namespace tread::learner::samples;

namespace {

/// All patterns turn left by 0.6 rad; the set predicts less.
Driving turning(int executions) {
  Driving driving;
  driving.patterns = {kLeft};
  driving.executions = executions;
  return driving;
}

double shippedYaw() {
  return smallSet().find(kLeft)->end().yaw;
}

}  // namespace

TEST_CASE("a running execution teaches before it has ended") {
  Bench bench(turning(1), "multi_model");
  bench.run(1.0);  // the first execution begins after .5 s
  REQUIRE(bench.publishedYaw(kLeft) == shippedYaw());
  bench.run(0.4);
  REQUIRE(bench.learned.empty());
  const double followed = bench.publishedYaw(kLeft);
  const double shipped = shippedYaw();
  bench.run(1.0);
  REQUIRE(bench.learned.size() == 1);
  const double learned = bench.publishedYaw(kLeft);
  // Between the shipped and the learned value, and at least half of the way.
  REQUIRE((followed - shipped) / (learned - shipped) > 0.5);
  REQUIRE((followed - shipped) / (learned - shipped) < 1.2);
}

TEST_CASE("an execution counts once, however often it was followed") {
  Bench followed(turning(7), "multi_model");
  Bench whole(turning(7), "multi_model", {}, 1, 0);
  followed.run(10.0);
  whole.run(10.0);
  REQUIRE(followed.learned.size() == 7);
  const auto published = [](const Bench& bench) {
    return std::set<int64_t>(bench.versions.begin(), bench.versions.end()).size();
  };
  REQUIRE(published(followed) > published(whole) + 6);
  // The same numbers, whether or not a part arrived in time.
  REQUIRE(followed.node().set().version() == whole.node().set().version());
  REQUIRE(samePredictions(followed.node().set(), whole.node().set()));
  REQUIRE(followed.versionsNeverWentBack());
}

TEST_CASE("what was followed is forgotten when its execution proves to be no fair one") {
  Driving driving = turning(1);
  driving.abort_every = 1;
  driving.abort_reason = StopReason::kStuck;
  Bench bench(driving, "multi_model");
  bench.run(1.4);
  REQUIRE(bench.publishedYaw(kLeft) != shippedYaw());
  bench.run(1.5);
  REQUIRE(bench.learned.size() == 1);
  REQUIRE_FALSE(bench.learned[0].accepted);
  REQUIRE(bench.learned[0].gate_reason == "aborted: stuck or pose frozen");
  REQUIRE(bench.publishedYaw(kLeft) == Approx(shippedYaw()).epsilon(1e-9));
}

TEST_CASE("an execution that the planner stopped teaches what was driven of it") {
  Driving driving = turning(5);
  driving.abort_every = 1;
  driving.abort_reason = StopReason::kStoppedByPlanner;
  Bench bench(driving, "multi_model");
  bench.run(8.0);
  REQUIRE(bench.learned.size() == 5);
  for (const learning_t& learned : bench.learned) {
    INFO(learned.gate_reason);
    REQUIRE(learned.accepted);
    REQUIRE(learned.changed);
  }
  REQUIRE(bench.publishedYaw(kLeft) == Approx(0.6).epsilon(0.05));
  // A rule with a trajectory table uses only complete executions.
  Bench table(driving, "collective");
  table.run(8.0);
  for (const learning_t& learned : table.learned) REQUIRE_FALSE(learned.accepted);
}

TEST_CASE("an execution whose motors got other commands is not followed either") {
  Driving driving = turning(1);
  driving.wrong_commands = true;
  Bench bench(driving, "multi_model");
  bench.run(3.0);
  REQUIRE(samePredictions(bench.node().set(), smallSet()));
}

TEST_CASE("a learner that is killed while it follows goes on as if it had not") {
  Bench killed(turning(6), "multi_model");
  Bench whole(turning(6), "multi_model");
  whole.run(10.0);
  killed.run(3.4);
  const std::string state = killed.node().stateText();
  std::string why;
  const auto parsed = parseState(state, smallSet(), why);
  REQUIRE(parsed);
  Learner restored(killed.config.rule, smallSet());
  REQUIRE(restored.restore(parsed->set, parsed->residuals, parsed->memory));
  REQUIRE(restored.memory() == parsed->memory);
  killed.run(6.6);
  REQUIRE(samePredictions(killed.node().set(), whole.node().set()));
}
