// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>
#include <set>

#include "modules/learner/core/state_text.hpp"
#include "tests/learner/bench.hpp"

using namespace tread;
using namespace tread::learner;
using namespace tread::learner::samples;

TEST_CASE("a learner on the bus learns what the ground does and publishes it") {
  Bench bench;
  bench.run(41.0);
  REQUIRE(bench.learned.size() >= 39);
  for (const learning_t& learned : bench.learned) {
    INFO(learned.gate_reason);
    REQUIRE(learned.accepted);
    REQUIRE(learned.changed);
  }
  REQUIRE(bench.publishedYaw(kLeft) == Approx(0.6).epsilon(0.02));
  REQUIRE(bench.publishedYaw(kRight) == Approx(-0.6).epsilon(0.02));
  REQUIRE(bench.published(kStraight).trajectory.back()[0] == Approx(0.9).epsilon(0.1));
  REQUIRE(bench.learned.front().error_position > 0.05);
  REQUIRE(bench.learned.back().error_position < 0.01);
  REQUIRE(bench.learned.front().error_position_after < bench.learned.front().error_position);
  REQUIRE(bench.versionsNeverWentBack());
}

TEST_CASE("off scores every execution and never changes the set") {
  Bench bench({}, "off");
  bench.run(20.0);
  REQUIRE(bench.learned.size() >= 18);
  for (const learning_t& learned : bench.learned) {
    REQUIRE(learned.accepted);
    REQUIRE_FALSE(learned.changed);
    REQUIRE(learned.error_position == Approx(bench.learned[0].error_position).margin(0.2));
  }
  REQUIRE(std::set<int64_t>(bench.versions.begin(), bench.versions.end()).size() == 1);
  REQUIRE(samePredictions(bench.node().set(), smallSet()));
}

TEST_CASE("dropped, repeated and reordered messages change nothing of what is learned") {
  FaultPlan faults;
  MessageFault execution;
  execution.channel = "EXECUTION";
  execution.receiver = "learner";
  execution.drop = 0.3;
  execution.duplicate = 0.3;
  execution.reorder = 0.3;
  execution.reorder_us = 300'000;
  MessageFault ins;
  ins.channel = "INS";
  ins.receiver = "learner";
  ins.duplicate = 0.2;
  ins.reorder = 0.3;
  ins.reorder_us = 90'000;
  faults.messages = {execution, ins};
  Driving driving;
  driving.set_version = 1;
  driving.executions = 30;
  Bench clean(driving);
  Bench faulty(driving, "collective", faults, 9);
  clean.run(35.0);
  faulty.run(35.0);
  REQUIRE(clean.learned.size() == 30);
  REQUIRE(faulty.learned.size() == 30);
  for (size_t i = 0; i < 30; ++i)
    REQUIRE(faulty.learned[i].learned_execution_id == static_cast<int64_t>(i + 1));
  REQUIRE(samePredictions(clean.node().set(), faulty.node().set()));
}

TEST_CASE("the same seed gives the same bytes") {
  const auto record = [] {
    std::vector<uint8_t> said;
    FaultPlan faults;
    faults.messages.push_back({});
    faults.messages.back().drop = 0.1;
    faults.messages.back().reorder = 0.1;
    Bench bench({}, "collective", faults, 4);
    bench.bus.setTap([&said](int64_t, const char*, const uint8_t* bytes, size_t size) {
      said.insert(said.end(), bytes, bytes + size);
    });
    bench.run(15.0);
    return said;
  };
  const auto first = record();
  REQUIRE(first.size() > 100'000);
  REQUIRE(first == record());
}

TEST_CASE("errors are scored with the version that the record names, not the newest") {
  Driving driving;
  driving.patterns = {kLeft};
  Bench newest(driving);
  newest.run(12.0);
  REQUIRE(newest.learned.back().error_position < 0.01);
  Bench named(driving);
  named.run(1.0);
  driving.set_version = named.node().set().version();
  Bench first(driving);
  first.run(12.0);
  REQUIRE(first.learned.back().scored_version == driving.set_version);
  REQUIRE(first.learned.back().error_position ==
          Approx(first.learned.front().error_position).epsilon(1e-6));
  REQUIRE(first.learned.back().error_position_after < 0.01);
}

TEST_CASE("a version that is no longer remembered gives no error, but is learned from") {
  Driving driving;
  driving.set_version = 2;
  Bench bench(driving);
  bench.run(5.0);
  REQUIRE(std::isnan(bench.learned.back().error_position));
  REQUIRE(bench.learned.back().changed);
}

TEST_CASE("refusals are counted in HEALTH with their reasons") {
  Driving driving;
  driving.abort_every = 3;
  Bench bench(driving);
  bench.run(20.0);
  REQUIRE(bench.counter("refused: aborted") == 6);
  REQUIRE(bench.counter("executions") ==
          bench.counter("learnable") + bench.counter("refused: aborted"));
  REQUIRE(bench.learned[2].gate_reason == "aborted: no good PROGRAM within its lease");
  REQUIRE_FALSE(bench.learned[2].accepted);
}

TEST_CASE("an execution whose motors got other commands than its pattern has is refused") {
  Driving driving;
  driving.wrong_commands = true;
  Bench bench(driving);
  bench.run(5.0);
  REQUIRE(bench.learned.size() >= 3);
  REQUIRE_FALSE(bench.learned[0].accepted);
  REQUIRE(bench.learned[0].gate_reason ==
          "command 0 was (0.700, 0.500) on the motors, (0.700, 1.000) in the pattern");
}

TEST_CASE("a command on the motors that is no number is another command, whichever side it is") {
  const double nan = std::nan("");
  const PatternSet set = smallSet();
  const MotionPattern& left = *set.find(kLeft);
  for (const bool on_left : {false, true}) {
    motor_t motor{};
    motor.motor_run_id = 5;
    motor.execution_id = 1;
    motor.channel_kind[0] = motor.channel_kind[1] = static_cast<int16_t>(CommandKind::kPower);
    motor.command[0] = static_cast<float>(on_left ? nan : left.commands[0][0]);
    motor.command[1] = static_cast<float>(on_left ? left.commands[0][1] : nan);
    CommandWatch watch;
    watch.add(motor);
    REQUIRE_FALSE(
        watch.unexpectedCommand({5, 1}, left, trackChannels(CommandKind::kPower)).empty());
  }
}

TEST_CASE("a pattern that is not in the set is refused") {
  Driving driving;
  driving.patterns = {99};
  driving.truth[99] = {0.5, 0.0, 0.0};
  Bench bench(driving);
  bench.run(3.0);
  REQUIRE(bench.learned[0].gate_reason == "pattern 99 is not in the set");
}

TEST_CASE("the whole state goes into the log, in parts") {
  Bench bench;
  bench.run(5.3);
  std::string text;
  for (const learner_state_t& part : bench.states)
    if (part.state_version == bench.node().set().version())
      text.append(part.state_bytes.begin(), part.state_bytes.end());
  std::string why;
  const auto state = parseState(text, smallSet(), why);
  REQUIRE(why.empty());
  REQUIRE(state->set.checksum() == bench.node().set().checksum());
}

TEST_CASE("a planner that starts late gets the set within two seconds") {
  Driving standing;
  standing.executions = 0;
  Bench bench(standing);
  bench.run(10.0);
  bench.versions.clear();
  bench.run(2.1);
  REQUIRE(bench.versions.size() >= smallSet().patterns().size());
}

TEST_CASE("while the INS is silent executions are refused, and learning goes on afterwards") {
  FaultPlan faults;
  MessageFault silence;
  silence.channel = "INS";
  silence.drop = 1.0;
  silence.from = 5'000'000;
  silence.until = 10'000'000;
  faults.messages = {silence};
  Driving driving;
  driving.executions = 20;
  Bench bench(driving, "collective", faults);
  bench.run(25.0);
  REQUIRE(bench.learned.size() == 20);
  REQUIRE(bench.counter("refused: no INS at its start") + bench.counter("refused: INS gap") +
              bench.counter("refused: covered time") ==
          6);
  REQUIRE(bench.learned.back().changed);
}

TEST_CASE(
    "GRIP says twice a second what the ground gives, and only what was really driven tells it") {
  const auto newestGrip = [](bool wrong_commands, double slide) {
    Driving driving;
    driving.wrong_commands = wrong_commands;
    driving.truth[kLeft] = {0.8, -slide, 0.6};
    Bench bench(driving);
    std::vector<grip_t> said;
    bench.bus.outside().subscribe<grip_t>(kGrip, [&](const grip_t& m) { said.push_back(m); });
    bench.run(12.0);
    CHECK(said.size() >= 23);
    CHECK(said.size() <= 25);
    CHECK(said.front().grip_signs == 0);
    CHECK(said.front().utime == 0);
    CHECK(said.front().deceleration == GripEstimator::kUnseen);
    return said.back();
  };
  const grip_t slid = newestGrip(false, 0.5);
  CHECK(slid.grip_signs >= 2);
  CHECK(slid.gave_way);
  CHECK(slid.deceleration < 1.0);
  CHECK(slid.deceleration > 0.15);
  CHECK(slid.utime > 0);
  CHECK_FALSE(newestGrip(false, 0.0).gave_way);
  CHECK(newestGrip(true, 0.5).grip_signs == 0);
}
