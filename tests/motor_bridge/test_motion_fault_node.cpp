// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The whole bridge when the motion in INS does not match the commands.
#include <functional>

#include <catch2/catch.hpp>

#include "tests/motor_bridge/node_world.hpp"

using namespace tread;
using namespace tread::motor;

namespace {

/// A robot driving straight at full power.
struct StraightWorld : NodeWorld {
  explicit StraightWorld(double right = 1.0) {
    planner().planner.right = right;
    planner().planner.least_power = 0.5;
    planner().planner.commands = 20;
    drive();
    run(20'000'000);
    REQUIRE(drives());
  }
};

}  // namespace

TEST_CASE("a robot that rolls beyond its limit stands within 250 ms, and the reason says it") {
  StraightWorld world;
  world.robot.roll = 0.6;
  CHECK(world.lastMotionWithin(3'000'000) <= 250'000);
  CHECK(world.motor.bridge_state == motor_t::STATE_DISARMED);
  CHECK(world.motor.state_reason.rfind("rolled 34 deg, limit 29", 0) == 0);
}

TEST_CASE("a robot with limits of tilt whose INS says that it measures no attitude stands") {
  StraightWorld world;
  world.robot.attitude = false;
  CHECK(world.lastMotionWithin(3'000'000) <= 250'000);
  CHECK(world.motor.state_reason.rfind("INS measures no roll and pitch", 0) == 0);
}

TEST_CASE("a pose that repeats itself with new times stops the robot within 1.5 s") {
  StraightWorld world;
  world.robot.frozen = true;
  const double before = world.robot.truth().x;
  CHECK(world.lastMotionWithin(3'000'000) <= 1'500'000);
  CHECK(world.motor.bridge_state == motor_t::STATE_DISARMED);
  CHECK(world.motor.state_reason.rfind("pose frozen", 0) == 0);
  CHECK(world.robot.truth().x - before < 1.5);
  world.run(20'000'000);
  CHECK(world.stoodFor() >= 20'000'000);
}

TEST_CASE("a position 3 m away, a heading off by 20 deg, and turns counted backwards stop it") {
  const std::function<void(DrivenRobot&)> kFaults[] = {
      [](DrivenRobot& robot) { robot.offset.x += 3.0; },
      [](DrivenRobot& robot) { robot.offset.yaw += 0.35; },
      [](DrivenRobot& robot) { robot.yaw_sign = -1.0; },
      [](DrivenRobot& robot) { robot.grip = 0.0; }};
  for (const auto& spoil : kFaults) {
    StraightWorld world(0.6);
    spoil(world.robot);
    CHECK(world.lastMotionWithin(3'000'000) <= 1'500'000);
    CHECK(world.motor.bridge_state == motor_t::STATE_DISARMED);
    INFO(world.motor.state_reason);
    CHECK(world.motor.state_reason.size() < 120);
  }
}

TEST_CASE("after a stop for its motion the robot is armed again once it measures well") {
  StraightWorld world;
  world.robot.frozen = true;
  world.run(3'000'000);
  REQUIRE(world.motor.bridge_state == motor_t::STATE_DISARMED);
  world.robot.frozen = false;
  world.run(4'000'000);
  CHECK(world.health.health_state == health_t::HEALTH_OK);
  world.say(true);
  world.run(5'000'000);
  CHECK(world.drives());
}
