// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "tests/motor_bridge/bridge_world.hpp"

using namespace tread;
using namespace tread::motor;

namespace {

constexpr int64_t kLease = 1'000'000;

/// Steps until the command is zero; returns the duration [us].
int64_t stepsToZero(BridgeWorld& world) {
  const int64_t from = world.now;
  while (!isZero(world.out.command) && world.now - from < 30'000'000) world.step();
  return world.now - from;
}

BridgeWorld worldThat(OperatorLost lost) {
  BridgeConfig config;
  config.operators.lost = lost;
  BridgeWorld world;
  world.bridge = Bridge(config);
  return world;
}

OperatorNotice notice(const BridgeWorld& world, int64_t station, const std::string& name) {
  return {station, name, true, world.now, 0, ""};
}

}  // namespace

TEST_CASE("without an operator's program ARM is refused, with the reason") {
  BridgeWorld world;
  world.operator_alive = false;
  world.drive();
  CHECK(world.state() == BridgeState::kDisarmed);
  CHECK(world.reason() == "not armed yet; ARM refused: no operator's program is heard (OPERATOR)");
}

TEST_CASE("operator killed, frozen or cut off: zero within the lease, armed again only by hand") {
  for (const bool frozen_view : {false, true}) {
    BridgeWorld world;
    world.drive();
    world.run(3'000'000);
    REQUIRE(world.state() == BridgeState::kDriving);
    const int64_t cut = world.now;
    for (int64_t seen = cut; !isZero(world.out.command);) {
      // A frozen view: its messages continue, its view of the robot does not.
      world.operator_alive = false;
      if (frozen_view && world.now % 200'000 == 0)
        world.bridge.receive(OperatorNotice{1, "operator", true, seen, 0, ""}, world.now);
      world.step();
      REQUIRE(world.now - cut < 10'000'000);
    }
    CHECK(world.now - cut <= kLease + BridgeWorld::kStep);
    CHECK(world.state() == BridgeState::kDisarmed);
    CHECK(world.reason() == "the operator is lost: operator has not seen the robot for 1.0 s");
    world.operator_alive = true;
    world.run(10'000'000);
    CHECK(world.state() == BridgeState::kDisarmed);
    world.arm();
    world.run(300'000);
    CHECK(world.state() == BridgeState::kDriving);
  }
}

TEST_CASE("`go_back`: programs count for as long as a return may last, but nothing is armed") {
  BridgeConfig config;
  config.operators.lost = OperatorLost::kGoBack;
  config.operators.return_us = 60'000'000;
  BridgeWorld world;
  world.bridge = Bridge(config);
  world.drive();
  world.run(3'000'000);
  world.operator_alive = false;
  world.run(59'000'000);
  CHECK(world.state() == BridgeState::kDriving);
  world.run(2'100'000);
  CHECK(world.state() == BridgeState::kDisarmed);
  CHECK(isZero(world.out.command));
  world.arm();
  world.run(3'000'000);
  CHECK(world.state() == BridgeState::kDisarmed);
}

TEST_CASE("`go_back`: standing for its waiting time with nobody there, it is disarmed") {
  BridgeWorld world = worldThat(OperatorLost::kGoBack);
  world.drive();
  world.run(3'000'000);
  world.operator_alive = false;
  world.planner.stands = true;
  world.run(29'000'000);
  CHECK(isArmed(world.state()));
  world.run(5'000'000);
  CHECK(world.state() == BridgeState::kDisarmed);
}

TEST_CASE("`finish`: what runs ends, nothing begins, and the robot is disarmed") {
  BridgeWorld world = worldThat(OperatorLost::kFinish);
  world.drive();
  world.run(3'000'000);
  REQUIRE(world.state() == BridgeState::kDriving);
  world.operator_alive = false;
  world.run(kLease + 300'000);
  CHECK(world.state() == BridgeState::kDriving);
  // The planner has no next pattern.
  const int64_t running = world.out.execution_id;
  world.planner_alive = false;
  stepsToZero(world);
  CHECK(world.last().execution_id <= running + 1);
  world.run(50'000);
  CHECK_FALSE(isArmed(world.state()));
}

TEST_CASE("`finish` has an end: a planner that never stops is stopped") {
  BridgeWorld world = worldThat(OperatorLost::kFinish);
  world.drive();
  world.run(1'000'000);
  world.operator_alive = false;
  CHECK(stepsToZero(world) < 17'000'000);
  CHECK(world.state() == BridgeState::kDisarmed);
}

TEST_CASE(
    "an operator who lets go stops the robot, which stays armed and is disarmed after a while") {
  BridgeWorld world;
  world.drive();
  world.run(1'000'000);
  world.operator_alive = false;
  world.bridge.receive(OperatorNotice{1, "operator", false, world.now, 0, ""}, world.now);
  world.step();
  CHECK(isZero(world.out.command));
  CHECK(world.state() == BridgeState::kStopping);
  CHECK(world.reason() == "operator has let go");
  world.run(20'000'000);
  CHECK(world.state() == BridgeState::kArmed);
  CHECK(isZero(world.out.command));
  world.run(11'000'000);
  CHECK(world.state() == BridgeState::kDisarmed);
}

TEST_CASE("two operators: the second one cannot arm, nor take over, before it is handed over") {
  BridgeWorld world;
  world.run(1'200'000);
  world.bridge.receive(notice(world, 2, "bob"), world.now);
  world.bridge.receive(ArmRequest{world.now, true, "bob", "mine"}, world.now);
  world.step();
  CHECK(world.reason() == "not armed yet; ARM refused: the robot is held by operator");
  world.arm();
  world.run(200'000);
  REQUIRE(world.state() == BridgeState::kDriving);
  world.bridge.receive(notice(world, 2, "bob"), world.now);
  OperatorNotice giving = notice(world, 1, "operator");
  giving.hand_over_to = "bob";
  world.bridge.receive(giving, world.now);
  world.operator_alive = false;
  for (int i = 0; i < 300; ++i) {
    if (i % 20 == 0) world.bridge.receive(notice(world, 2, "bob"), world.now);
    world.step();
    REQUIRE(world.state() == BridgeState::kDriving);
  }
  world.run(kLease + 20'000);
  CHECK(world.reason() == "the operator is lost: bob has not seen the robot for 1.0 s");
}

TEST_CASE("a request from another clock is refused with a word of clocks") {
  BridgeWorld world;
  world.run(2'000'000);
  for (const int64_t off : {-3'000'000, 1'000'000}) {
    world.bridge.receive(ArmRequest{world.now + off, true, "operator", "go"}, world.now);
    world.step();
    CHECK_THAT(world.reason(), Catch::Contains("ARM ignored: its time is") &&
                                   Catch::Contains("do the clocks differ?"));
  }
  world.bridge.receive(EstopRequest{world.now, true, "operator", "test"}, world.now);
  world.step();
  world.bridge.receive(EstopRequest{world.now + 1'000'000, false, "operator", ""}, world.now);
  world.step();
  CHECK(world.state() == BridgeState::kEstop);
  CHECK_THAT(world.reason(), Catch::Contains("do the clocks differ?"));
}
