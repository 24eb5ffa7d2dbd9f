// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "modules/learner/core/hand_watch.hpp"
#include "tests/learner/bench.hpp"

using namespace tread;
using namespace tread::learner;
using namespace tread::learner::samples;

namespace {

/// Rest, cruise and patterns similar to the shipped ones.
PatternSet drivenSet() {
  PatternSetContent content;
  content.name = "driven";
  content.classes = {{"rest", {}, {}}, {"cruise", {1.0, 0.0, 0.0}, {1.0, 1.0}}};
  const auto add = [&](int id, const char* name, const char* entry, const char* exit,
                       std::vector<Command> commands) {
    MotionPattern pattern;
    pattern.id = id;
    pattern.name = name;
    pattern.entry_class = entry;
    pattern.exit_class = exit;
    for (size_t i = 0; i < commands.size(); ++i)
      pattern.trajectory.push_back({0.04 * static_cast<double>(i + 1), 0.0, 0.0});
    pattern.commands = std::move(commands);
    content.patterns.push_back(pattern);
  };
  add(1, "straight", "cruise", "cruise", std::vector<Command>(20, {1.0, 1.0}));
  add(2, "short", "cruise", "cruise", std::vector<Command>(10, {1.0, 1.0}));
  add(3, "stop", "cruise", "rest", std::vector<Command>(15, {0.0, 0.0}));
  std::vector<Command> turn(20, {0.5, 1.0});
  turn.resize(30, {1.0, 1.0});
  add(4, "left", "cruise", "cruise", turn);
  add(5, "start", "rest", "cruise", std::vector<Command>(10, {1.0, 1.0}));
  std::string why;
  const auto set = PatternSet::make(content, why);
  INFO(why);
  REQUIRE(set);
  return *set;
}

/// MOTOR at 20 Hz, fed to a watch.
struct Motors {
  HandWatch watch;
  PatternSet set = drivenSet();
  int64_t now = 1'000'000;
  std::vector<HandDrivenPattern> found;

  void give(Command command, double seconds, bool by_hand = true, bool lost = false) {
    for (const int64_t end = now + static_cast<int64_t>(seconds * 1e6); now < end; now += 50'000) {
      watch.add({now, command, by_hand}, lost);
      lost = false;
      for (const HandDrivenPattern& one : watch.take(set, true)) found.push_back(one);
    }
  }
  std::vector<int> ids() const {
    std::vector<int> ids;
    for (const HandDrivenPattern& one : found) ids.push_back(one.pattern_id);
    return ids;
  }
};

/// A robot on a straight line with MOTOR in state MANUAL.
struct HandDriver {
  Bench& bench;
  int64_t seq = 0;
  double x = 0.0;

  explicit HandDriver(Bench& given) : bench(given) {}
  void drive(double seconds, double speed, float command) {
    Bus& robot = bench.bus.outside();
    for (int i = 0; i < static_cast<int>(seconds * 50.0); ++i) {
      x += speed * 0.02;
      ins_t ins{};
      ins.utime = bench.bus.now();
      ins.seq = seq;
      ins.position[0] = x;
      ins.orientation[0] = 1.0;
      robot.publish(kIns, ins);
      motor_t motor{};
      motor.utime = bench.bus.now();
      motor.seq = seq++;
      motor.bridge_state = motor_t::STATE_MANUAL;
      motor.channel_kind[0] = motor.channel_kind[1] = 1;
      motor.command[0] = motor.command[1] = command;
      robot.publish(kMotor, motor);
      bench.run(0.02);
    }
  }
};

}  // namespace

TEST_CASE("full ahead by hand is straight patterns after the first half second, without overlap") {
  Motors motors;
  motors.give({0.0, 0.0}, 1.0);
  motors.give({0.5, 0.5}, 0.3);
  const int64_t full = motors.now;
  motors.give({1.0, 1.0}, 4.0);
  REQUIRE(motors.ids() == std::vector<int>{1, 1, 1});
  CHECK(motors.found[0].started == full + 500'000);
  for (size_t i = 0; i < 3; ++i) {
    CHECK(motors.found[i].ended - motors.found[i].started == 1'000'000);
    if (i > 0) CHECK(motors.found[i].started == motors.found[i - 1].ended);
  }
}

TEST_CASE("the stick let go at full speed is a stop, once, however long it stands then") {
  Motors motors;
  motors.give({1.0, 1.0}, 2.0);
  motors.give({0.0, 0.0}, 30.0);
  CHECK(motors.ids() == std::vector<int>{1, 2, 3});
}

TEST_CASE("a pattern of two parts is found where both are driven, the longest one counts") {
  Motors motors;
  motors.give({1.0, 1.0}, 0.6);
  motors.give({0.5, 1.0}, 1.0);
  motors.give({1.0, 1.0}, 0.5);
  motors.give({0.0, 0.0}, 2.0);
  CHECK(motors.ids() == std::vector<int>{4, 3});
}

TEST_CASE("from rest a pattern needs half a second of standing before it") {
  Motors motors;
  motors.give({0.3, 0.3}, 1.0);
  motors.give({0.0, 0.0}, 0.6);
  motors.give({1.0, 1.0}, 0.5);
  motors.give({0.3, 0.3}, 1.0);
  CHECK(motors.ids() == std::vector<int>{5});
}

TEST_CASE("other commands, a planner's ones, and what was not heard whole teach nothing") {
  Motors motors;
  SECTION("a little less") {
    motors.give({0.99, 0.99}, 5.0);
  }
  SECTION("the planner's") {
    motors.give({1.0, 1.0}, 5.0, false);
  }
  SECTION("taken over within") {
    motors.give({1.0, 1.0}, 1.2, false);
    motors.give({1.0, 1.0}, 0.35, true);
    motors.give({0.5, 0.5}, 1.0, true);
  }
  SECTION("messages lost within") {
    motors.give({1.0, 1.0}, 1.2);
    motors.give({1.0, 1.0}, 0.9, true, true);
    motors.give({1.0, 1.0}, 0.9, true, true);
    motors.give({1.0, 1.0}, 0.4, true, true);
    motors.found.clear();
    motors.give({0.5, 0.5}, 1.0);
  }
  CHECK(motors.found.empty());
}

TEST_CASE(
    "a pattern that a person leaves is its beginning, unless it is short or the robot was taken") {
  Motors motors;
  motors.give({1.0, 1.0}, 0.6);
  SECTION("left by the person") {
    motors.give({0.5, 1.0}, 0.6);
    motors.give({0.2, 0.2}, 2.0);
    REQUIRE(motors.ids() == std::vector<int>{4});
    CHECK_FALSE(motors.found[0].completed);
    CHECK(motors.found[0].ended - motors.found[0].started == 600'000);
  }
  SECTION("after less than 0.4 s") {
    motors.give({0.5, 1.0}, 0.35);
    motors.give({0.2, 0.2}, 2.0);
    REQUIRE(motors.found.empty());
  }
  SECTION("taken from the person") {
    motors.give({0.5, 1.0}, 0.6);
    motors.give({0.0, 0.0}, 2.0, false);
    REQUIRE(motors.found.empty());
  }
}

TEST_CASE("the beginning of a pattern driven by hand teaches a rule that learns from parts") {
  for (const char* rule : {"multi_model", "collective"}) {
    Driving driving;
    driving.executions = 0;
    Bench bench(driving, rule);
    bench.bus.kill("robot");  // the test itself acts as the robot
    HandDriver person(bench);
    person.drive(1.26, 0.9, 1.0F);  // .5 s of the entry class, then 0.76 of 1 s
    person.drive(1.0, 0.0, 0.3F);
    INFO(rule);
    const bool parts = std::string(rule) == "multi_model";
    REQUIRE(bench.learned.size() == (parts ? 1U : 0U));
    if (!parts) continue;
    INFO(bench.learned[0].gate_reason);
    CHECK(bench.learned[0].accepted);
    CHECK(bench.learned[0].changed);
  }
}

TEST_CASE("the learner learns from what a person drives, through the same gates") {
  Driving driving;
  driving.executions = 0;
  Bench bench(driving);
  bench.bus.kill("robot");  // the test itself acts as the robot
  HandDriver person(bench);
  SECTION("at the speed of the class it is learned from") {
    person.drive(4.0, 0.9, 1.0F);
    person.drive(1.0, 0.0, 0.0F);
    REQUIRE(bench.learned.size() >= 2);
    for (const learning_t& learned : bench.learned) {
      CHECK(learned.learned_run_id == 0);
      CHECK(learned.learned_pattern_id == kStraight);
      CHECK(learned.accepted);
    }
    CHECK(bench.learned.front().changed);
    CHECK(bench.learned.front().measured_end[0] == Approx(0.9).margin(0.02));
  }
  SECTION("at another speed, too: that is what the ground makes of the command") {
    person.drive(4.0, 0.3, 1.0F);
    person.drive(1.0, 0.0, 0.0F);
    REQUIRE(!bench.learned.empty());
    for (const learning_t& learned : bench.learned) CHECK(learned.accepted);
  }
  SECTION("faster than the vehicle can be it is refused") {
    person.drive(4.0, 2.5, 1.0F);
    person.drive(1.0, 0.0, 0.0F);
    REQUIRE(!bench.learned.empty());
    for (const learning_t& learned : bench.learned) CHECK_FALSE(learned.accepted);
    CHECK(bench.learned.front().gate_reason.find("possible") != std::string::npos);
  }
}

TEST_CASE("a command is steady after half a second of it without a break, whoever gave it") {
  Motors motors;
  const Command full{1.0, 1.0};
  motors.give({0.0, 0.0}, 1.0, false);
  motors.give(full, 0.45, false);
  REQUIRE_FALSE(motors.watch.steadyBefore(full, motors.now, 50'000));
  motors.give(full, 0.05);
  REQUIRE(motors.watch.steadyBefore(full, motors.now, 50'000));
  REQUIRE_FALSE(motors.watch.steadyBefore({1.0, 0.9}, motors.now, 50'000));
  motors.give(full, 0.2, true, true);
  REQUIRE_FALSE(motors.watch.steadyBefore(full, motors.now, 50'000));
}
