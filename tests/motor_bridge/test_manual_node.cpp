// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <limits>

#include <catch2/catch.hpp>

#include "common/messages/blank.hpp"
#include "tests/motor_bridge/node_world.hpp"

using namespace tread;
using namespace tread::motor;

namespace {

/// A program for manual control at 50 Hz, on a bridge with its controller.
struct HandOnTheBus : NodeWorld {
  manual_t wish = blank<manual_t>();

  HandOnTheBus() {
    wish.station = 7;
    wish.operator_name = "operator";
    wish.hand_left = wish.hand_right = 0.0F;
    wish.hold = true;
  }
  void tell() {
    wish.utime = now();
    wish.seen_utime = motor.utime;
    ++wish.seq;
    bus.outside().publish(kManual, wish);
  }
  void runHand(int64_t us) {
    for (const int64_t end = now() + us; now() < end; run(20'000)) tell();
  }
  /// Until a person drives at full stick.
  void driveByHand() {
    drive();
    runHand(200'000);
    REQUIRE(drives());
    wish.hand_left = 1.0F;
    wish.hand_right = -1.0F;
    runHand(1'000'000);
  }
};

}  // namespace

TEST_CASE("a stick that is moved has the motors within 100 ms, and MOTOR says who drives") {
  HandOnTheBus world;
  world.drive();
  world.runHand(200'000);
  REQUIRE(world.drives());
  world.wish.hand_left = 1.0F;
  world.wish.hand_right = -1.0F;
  world.runHand(100'000);
  CHECK(world.device.motor1(world.now()) > 0);
  CHECK(world.device.motor1(world.now()) <= 100);
  CHECK(world.device.motor2(world.now()) < 0);
  CHECK(world.motor.bridge_state == motor_t::STATE_MANUAL);
  CHECK(world.motor.state_reason == "driven by hand by operator");
  CHECK(world.motor.channel_kind[0] == program_slot_t::KIND_POWER);
  CHECK(world.motor.execution_id == 0);
  world.runHand(1'000'000);
  CHECK(world.motor.command[0] == 0.5F);
  CHECK(world.motor.command[1] == -0.5F);
  CHECK(world.device.motor1(world.now()) == 500);
  CHECK(world.execution.records.back().outcome == execution_record_t::OUTCOME_ABORTED);
  const int64_t motors = world.motors;
  world.runHand(2'000'000);
  CHECK(world.motors - motors >= 40);
}

TEST_CASE("the hand's program killed: zero within 200 ms and a step of what it saw last") {
  HandOnTheBus world;
  world.driveByHand();
  const int64_t seen = world.motor.utime;
  world.tell();
  const int64_t told = world.now();
  const int64_t moved = world.lastMotionWithin(2'000'000);
  CHECK(told + moved - seen <= 200'000 + 15'000);
  CHECK(world.motor.bridge_state == motor_t::STATE_MANUAL);
  CHECK(world.motor.state_reason == "in the hand of operator, who is silent");
}

TEST_CASE("button released: the motors stand within 30 ms, given back the planner drives on") {
  HandOnTheBus world;
  world.driveByHand();
  world.wish.hold = false;
  world.tell();
  CHECK(world.lastMotionWithin(20'000) <= 30'000);
  world.runHand(1'000'000);
  CHECK(world.stoodFor() >= 900'000);
  world.wish.give_back = true;
  world.runHand(300'000);
  CHECK(world.drives());
}

TEST_CASE(
    "the bridge killed while driven by hand: the controller's watchdog stops the motors, and "
    "nothing moves by hand before ARM") {
  HandOnTheBus world;
  world.driveByHand();
  world.bus.kill("motor_bridge");
  CHECK(world.lastMotionWithin(1'000'000) <= 250'000);
  world.bus.restart("motor_bridge");
  world.runHand(5'000'000);
  CHECK(world.stoodFor() >= 4'900'000);
  CHECK(world.motor.bridge_state == motor_t::STATE_DISARMED);
}

TEST_CASE("a stick that is at an extreme or unknown from its first message on moves nothing") {
  HandOnTheBus world;
  const float place = GENERATE(1.0F, std::numeric_limits<float>::quiet_NaN());
  world.wish.hand_left = place;
  world.wish.hold = false;
  world.drive();
  world.wish.hold = true;
  for (int i = 0; i < 10; ++i) {
    world.runHand(200'000);
    world.wish.hold = !world.wish.hold;
    REQUIRE(world.motor.bridge_state != motor_t::STATE_MANUAL);
  }
  world.wish.hold = true;
  world.runHand(100'000);
  CHECK_THAT(world.motor.state_reason, Catch::Contains("the stick was not seen at rest"));
  world.wish.hand_left = 0.0F;
  world.runHand(100'000);
  world.wish.hand_left = 1.0F;
  world.runHand(100'000);
  CHECK(world.motor.bridge_state == motor_t::STATE_MANUAL);
}

TEST_CASE("a program that says nothing of the stick's place says no rest") {
  HandOnTheBus world;
  world.drive();
  manual_t bare = blank<manual_t>();
  bare.station = world.wish.station;
  bare.operator_name = world.wish.operator_name;
  bare.hold = true;
  world.wish = bare;
  world.runHand(200'000);
  world.wish.hand_left = world.wish.hand_right = 1.0F;
  world.runHand(500'000);
  CHECK(world.motor.bridge_state != motor_t::STATE_MANUAL);
}
