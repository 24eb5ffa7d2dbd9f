// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>
#include <memory>
#include <stdexcept>
#include <vector>

#include <catch2/catch.hpp>

#include "common/bus/virtual_bus.hpp"
#include "tools/robot/drive/drive_call.hpp"

namespace tread::drive {
namespace {

using operators::CallResult;

const Wishes kRests{0.0, 0.0};

/// A stick controlled by the test.
class HeldStick : public Stick {
 public:
  HeldStick(Wishes& wishes, std::string& gone) : wishes_(wishes), gone_(gone) {}
  Wishes read(int64_t /*now*/) override {
    if (!gone_.empty()) throw std::runtime_error(gone_);
    return wishes_;
  }
  std::string name() const override { return "stick"; }
  std::string keys() const override { return ""; }

 private:
  Wishes& wishes_;
  std::string& gone_;
};

class Idle : public Node {
 public:
  int64_t period() const override { return 1'000'000; }
  void step(int64_t /*utime*/) override {}
};

/// A robot with output set by the test, and a program for manual control at the outside of its bus.
struct Cockpit {
  VirtualBus bus{1};
  Wishes wishes = kRests;
  std::string gone;
  int16_t state = motor_t::STATE_DISARMED;
  bool robot_there = true;
  std::vector<manual_t> told;
  std::vector<arm_t> arms;
  std::vector<operator_t> operators_heard;
  std::unique_ptr<DriveCall> call;
  Bus* robot = nullptr;

  Cockpit() {
    bus.addNode("robot", [this](Bus& end) {
      robot = &end;
      end.subscribe<manual_t>(kManual, [this](const manual_t& m) { told.push_back(m); });
      end.subscribe<arm_t>(kArm, [this](const arm_t& m) { arms.push_back(m); });
      end.subscribe<operator_t>(kOperator,
                                [this](const operator_t& m) { operators_heard.push_back(m); });
      return std::make_unique<Idle>();
    });
    call = std::make_unique<DriveCall>(bus.outside(),
                                       operators::Requester{"ADA", "test", "ada@station"},
                                       std::make_unique<HeldStick>(wishes, gone));
  }
  CallResult run(int64_t us) {
    CallResult result = CallResult::kPending;
    for (const int64_t end = bus.now() + us; bus.now() < end && result == CallResult::kPending;
         bus.runUntil(bus.now() + 10'000)) {
      if (robot_there && bus.now() % 50'000 == 0) tellMotor();
      result = call->step(bus.now());
    }
    return result;
  }
  void tellMotor() const {
    motor_t motor{};
    motor.utime = bus.now();
    motor.bridge_state = state;
    motor.state_reason = "so it is";
    motor.battery_voltage = 24.5F;
    motor.command[0] = motor.command[1] = 0.25F;
    robot->publish(kMotor, motor);
  }
};

}  // namespace

TEST_CASE("MANUAL comes at 50 Hz with what was seen, beside OPERATOR of the same station") {
  Cockpit pit;
  pit.wishes.hold = true;
  pit.wishes.forward = 0.5;
  pit.wishes.turn = 0.25;
  pit.run(1'000'000);
  CHECK(pit.told.size() >= 40);
  CHECK(pit.told.size() <= 60);
  const manual_t& last = pit.told.back();
  CHECK(last.hold);
  CHECK(last.hand_left == 0.25F);
  CHECK(last.hand_right == 0.75F);
  CHECK(last.operator_name == "ada@station");
  CHECK(pit.bus.now() - last.seen_utime <= 100'000);
  REQUIRE(!pit.operators_heard.empty());
  CHECK(last.station == pit.operators_heard.back().station);
  for (size_t i = 1; i < pit.told.size(); ++i) CHECK(pit.told[i].seq > pit.told[i - 1].seq);
}

TEST_CASE(
    "a robot that is not heard gets nothing, and what was seen stands still with its silence") {
  Cockpit pit;
  pit.robot_there = false;
  pit.wishes.hold = true;
  pit.run(500'000);
  CHECK(pit.told.empty());
  CHECK_THAT(pit.call->describe(pit.bus.now()), Catch::Contains("no MOTOR message"));
  pit.robot_there = true;
  pit.run(500'000);
  const int64_t heard = pit.told.back().seen_utime;
  pit.robot_there = false;
  pit.run(1'000'000);
  CHECK(pit.told.back().seen_utime <= heard + 50'000);
  CHECK_THAT(pit.call->describe(pit.bus.now()), Catch::Contains("MOTOR has fallen silent"));
}

TEST_CASE("a released button is told at once, not with the next period") {
  Cockpit pit;
  pit.wishes.hold = true;
  pit.run(1'000'000);
  pit.wishes.hold = false;
  pit.run(20'000);
  CHECK_FALSE(pit.told.back().hold);
}

TEST_CASE("a key that stops disarms a robot that drives by itself, and one in the hand not") {
  for (const int16_t state : {motor_t::STATE_DRIVING, motor_t::STATE_MANUAL}) {
    Cockpit pit;
    pit.state = state;
    pit.run(500'000);
    pit.wishes.stop = true;
    pit.run(200'000);
    CHECK(pit.arms.empty() == (state == motor_t::STATE_MANUAL));
    for (const arm_t& arm : pit.arms) CHECK_FALSE(arm.armed);
  }
}

TEST_CASE("a key that stops ends the asking, too") {
  Cockpit pit;
  pit.run(500'000);
  pit.wishes.arm = true;
  pit.run(200'000);
  REQUIRE(!pit.arms.empty());
  pit.wishes.arm = false;
  pit.wishes.stop = true;
  pit.run(200'000);
  pit.wishes.stop = false;
  pit.arms.clear();
  pit.run(2'000'000);
  CHECK(pit.arms.empty());
}

TEST_CASE("the arm button asks until the robot is armed, and an old press does not arm it again") {
  Cockpit pit;
  pit.run(500'000);
  CHECK(pit.arms.empty());
  pit.wishes.arm = true;
  pit.run(300'000);
  REQUIRE(pit.arms.size() >= 2);
  CHECK(pit.arms.back().armed);
  CHECK(pit.arms.back().armed_by == "ADA (ada@station)");
  pit.state = motor_t::STATE_ARMED;
  pit.run(200'000);
  pit.arms.clear();
  pit.state = motor_t::STATE_FAULT;
  pit.run(3'000'000);
  CHECK(pit.arms.empty());
  pit.wishes = kRests;
  pit.wishes.disarm = true;
  pit.run(100'000);
  REQUIRE(!pit.arms.empty());
  CHECK_FALSE(pit.arms.back().armed);
}

TEST_CASE("a short press gives back for long enough to be heard") {
  Cockpit pit;
  pit.run(500'000);
  pit.wishes.give_back = true;
  pit.run(10'000);
  pit.wishes.give_back = false;
  pit.run(250'000);
  CHECK(pit.told.back().give_back);
  pit.run(200'000);
  CHECK_FALSE(pit.told.back().give_back);
}

TEST_CASE("a stick that is gone ends in one line, and a robot in the hand is disarmed and let go") {
  Cockpit pit;
  pit.state = motor_t::STATE_MANUAL;
  pit.wishes.hold = true;
  pit.wishes.forward = 1.0;
  pit.run(500'000);
  pit.gone = "the gamepad is gone: No such device";
  CHECK(pit.run(100'000) == CallResult::kRefused);
  pit.call->letGo(pit.bus.now());
  pit.bus.runUntil(pit.bus.now() + 10'000);
  CHECK(pit.call->describe(pit.bus.now()) ==
        "the gamepad is gone: No such device; the robot is let go");
  CHECK_FALSE(pit.told.back().hold);
  CHECK_FALSE(pit.told.back().give_back);
  CHECK(std::isnan(pit.told.back().hand_left));  // an unplugged stick is not at rest
  REQUIRE(!pit.arms.empty());
  CHECK_FALSE(pit.arms.back().armed);
  CHECK(pit.operators_heard.back().allowed == operator_t::ALLOW_NOTHING);
}

TEST_CASE("ending while the planner drives stops nobody: the operator's other programs go on") {
  Cockpit pit;
  pit.state = motor_t::STATE_DRIVING;
  pit.run(500'000);
  pit.wishes.ended = true;
  CHECK(pit.run(100'000) == CallResult::kDone);
  pit.call->letGo(pit.bus.now());
  pit.bus.runUntil(pit.bus.now() + 10'000);
  CHECK(pit.arms.empty());
}

TEST_CASE("a stick that is not known is told as unknown, at 50 Hz, and to the person in one line") {
  Cockpit pit;
  pit.wishes = Wishes{};
  pit.wishes.hold = true;
  pit.run(1'000'000);
  REQUIRE(pit.told.size() >= 40);
  CHECK(pit.told.size() <= 60);
  CHECK(std::isnan(pit.told.back().hand_left));
  CHECK(std::isnan(pit.told.back().hand_right));
  CHECK(pit.told.back().hold);
  const std::string line = "stick not yet seen at rest: move it in all directions once";
  CHECK_THAT(pit.call->describe(pit.bus.now()), Catch::Contains(line));
  pit.wishes.forward = 0.0;  // one axis is not enough
  pit.run(100'000);
  CHECK(std::isnan(pit.told.back().hand_left));
  CHECK_THAT(pit.call->describe(pit.bus.now()), Catch::Contains(line));
  pit.wishes.turn = 0.0;
  pit.run(100'000);
  CHECK(pit.told.back().hand_left == 0.0F);
  CHECK_THAT(pit.call->describe(pit.bus.now()), !Catch::Contains(line));
}

TEST_CASE("the line shows state, commands, battery, button and reason") {
  Cockpit pit;
  pit.state = motor_t::STATE_MANUAL;
  pit.wishes.hold = true;
  pit.run(500'000);
  const std::string line = pit.call->describe(pit.bus.now());
  for (const char* word : {"BY HAND", "left +0.25 right +0.25", "24.5 V", "held", "so it is"})
    CHECK_THAT(line, Catch::Contains(word));
}

}  // namespace tread::drive
