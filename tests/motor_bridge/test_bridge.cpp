// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <limits>
#include <random>

#include <catch2/catch.hpp>

#include "tests/motor_bridge/bridge_world.hpp"

using namespace tread;
using namespace tread::motor;

namespace {

/// Steps until the command is zero; returns how long it took [us].
int64_t timeToZero(BridgeWorld& world) {
  const int64_t from = world.now;
  do {
    world.step();
  } while (!isZero(world.out.command) && world.now - from < 10'000'000);
  return world.now - from;
}

}  // namespace

TEST_CASE("armed with a planner and an INS it drives, series joined to series without a gap") {
  BridgeWorld world;
  world.drive();
  REQUIRE(world.state() == BridgeState::kDriving);
  for (int i = 0; i < 6'000; ++i) {
    world.step();
    REQUIRE_FALSE(isZero(world.out.command));
  }
  const auto& records = world.bridge.executions().records();
  for (size_t i = 0; i + 1 < records.size(); ++i) {
    CHECK(records[i].ended == records[i + 1].started);
    CHECK(records[i].ended - records[i].started == 400'000);
    CHECK(records[i].commands_played == records[i].commands_total);
  }
}

TEST_CASE("it gives the planner's commands, unchanged, with their execution and index") {
  BridgeWorld world;
  world.drive();
  world.run(10'000'000);
  const int64_t since_start = world.now - world.last().started;
  CHECK(world.out.execution_id == world.last().execution_id);
  CHECK(world.out.command_index == since_start / 50'000);
  CHECK(world.out.run_id == 1);
  CHECK(world.out.kinds == kindsOf(trackChannels(CommandKind::kPower)));
}

TEST_CASE("without ARM nothing ever moves") {
  BridgeWorld world;
  for (int i = 0; i < 60'000; ++i) {
    world.step();
    REQUIRE(isZero(world.out.command));
  }
  CHECK(world.bridge.executions().records().empty());
}

TEST_CASE("a silent planner: zero one step after the lease, then ARM is needed") {
  BridgeWorld world;
  world.planner.commands = 200;
  world.drive();
  world.planner_alive = false;
  const int64_t lease_end = world.now - world.now % 50'000 - 1'000 + 200'000;
  timeToZero(world);
  CHECK(world.now - lease_end <= BridgeWorld::kStep);
  CHECK(world.state() == BridgeState::kDisarmed);
  CHECK(world.reason() == "no good PROGRAM within its lease");
  CHECK(world.last().outcome == ExecutionOutcome::kAborted);
  CHECK(world.last().reason.words == "no good PROGRAM within its lease");
  world.planner_alive = true;
  world.run(5'000'000);
  CHECK(world.state() == BridgeState::kDisarmed);
  world.arm();
  world.run(200'000);
  CHECK(world.state() == BridgeState::kDriving);
}

TEST_CASE(
    "series end without a next: zero in the very step, still armed, goes on with the next "
    "program") {
  BridgeWorld world;
  world.drive();
  world.planner_alive = false;
  Program last = world.planner.plan(world.now, newest(world.bridge.executions()));
  last.next = ProgramSlot{};
  world.bridge.receive(last, world.now);
  while (world.last().outcome == ExecutionOutcome::kRunning) {
    world.step();
    last.utime = world.now;
    world.bridge.receive(last, world.now);
  }
  CHECK(isZero(world.out.command));
  CHECK(world.now == world.last().ended);
  CHECK(world.last().outcome == ExecutionOutcome::kCompleted);
  CHECK(world.state() == BridgeState::kStopping);
  world.planner_alive = true;
  world.run(100'000);
  CHECK(world.state() == BridgeState::kDriving);
}

TEST_CASE("an empty running slot stops at once and stays armed") {
  BridgeWorld world;
  world.drive();
  world.planner_alive = false;
  world.bridge.receive(makeProgram(world.now + 1, ProgramSlot{}), world.now + 1);
  CHECK(timeToZero(world) == BridgeWorld::kStep);
  CHECK(world.state() == BridgeState::kStopping);
  CHECK(world.reason() == "stopped by the planner");
  CHECK(world.last().reason.words == "stopped by the planner");
  CHECK(world.last().outcome == ExecutionOutcome::kAborted);
}

TEST_CASE("a silent INS stops 100 ms later") {
  BridgeWorld world;
  world.drive();
  world.ins_alive = false;
  CHECK(timeToZero(world) <= 100'000 + BridgeWorld::kStep);
  CHECK(world.state() == BridgeState::kDisarmed);
  CHECK(world.reason() == "INS is stale: nothing new within 100 ms");
}

TEST_CASE("E-stop, link fault and device fault stop in the next step") {
  BridgeWorld world;
  world.drive();
  SECTION("E-stop") {
    world.bridge.receive(EstopRequest{world.now, true, "operator", "person"}, world.now);
    CHECK(timeToZero(world) == BridgeWorld::kStep);
    CHECK(world.state() == BridgeState::kEstop);
    CHECK(world.out.hold_device_stop);
    world.run(2'000'000);
    world.arm();
    world.run(100'000);
    CHECK(world.state() == BridgeState::kEstop);
    world.bridge.receive(EstopRequest{world.now, false, "operator", "clear"}, world.now);
    world.step();
    CHECK(world.out.release_device_stop);
    CHECK_FALSE(world.out.hold_device_stop);
  }
  SECTION("link") {
    world.device.link_fault = "controller lost";
    CHECK(timeToZero(world) == BridgeWorld::kStep);
    CHECK(world.state() == BridgeState::kFault);
  }
  SECTION("device") {
    world.device.device_fault = "controller: overheat";
    CHECK(timeToZero(world) == BridgeWorld::kStep);
    CHECK(world.state() == BridgeState::kFault);
    CHECK(world.reason() == "controller: overheat");
  }
  world.device = {};
  world.run(1'200'000);
  CHECK(isZero(world.out.command));
  world.arm();
  world.run(200'000);
  CHECK(world.state() == BridgeState::kDriving);
}

TEST_CASE("clearing an E-stop twice within a step releases the controller's own, too") {
  BridgeWorld world;
  world.drive();
  world.bridge.receive(EstopRequest{world.now, true, "operator", "person"}, world.now);
  world.step();
  REQUIRE(world.state() == BridgeState::kEstop);
  for (int copy = 0; copy < 2; ++copy)
    world.bridge.receive(EstopRequest{world.now, false, "operator", "gone"}, world.now);
  world.step();
  CHECK(world.out.release_device_stop);
  CHECK_FALSE(world.out.hold_device_stop);
}

TEST_CASE("an E-stop that the controller has kept over a restart of the bridge must be cleared") {
  BridgeWorld world;
  world.device.link_fault = "controller is being started up";
  world.run(500'000);
  world.device = DeviceReport{"", "the controller's emergency stop", true};
  world.run(1'500'000);
  CHECK(world.state() == BridgeState::kEstop);
  CHECK(world.reason() ==
        "E-stop: the controller has held it since before the start (motor_bridge)");
  world.arm();
  world.run(200'000);
  CHECK(world.state() == BridgeState::kEstop);
  CHECK(world.out.hold_device_stop);
  world.bridge.receive(EstopRequest{world.now, false, "operator", "clear"}, world.now);
  world.step();
  CHECK(world.out.release_device_stop);
  world.device = DeviceReport{};
  world.run(1'500'000);
  CHECK(world.state() == BridgeState::kDisarmed);
  world.arm();
  world.run(200'000);
  CHECK(world.state() == BridgeState::kDriving);
}

TEST_CASE("a stop at the controller itself while the bridge runs is released by ARM") {
  BridgeWorld world;
  world.drive();
  world.device = DeviceReport{"", "the controller's emergency stop", true};
  world.run(500'000);
  CHECK(world.state() == BridgeState::kFault);
  world.arm();
  world.step();
  CHECK(world.out.release_device_stop);
}

TEST_CASE("one bad slot in one program stops, whichever slot it is") {
  for (const bool in_next : {false, true}) {
    for (int fault = 0; fault < 4; ++fault) {
      BridgeWorld world;
      world.drive();
      Program program = world.planner.plan(world.now + 1, newest(world.bridge.executions()));
      ProgramSlot& slot = in_next ? program.next : program.running;
      if (fault == 0) slot.series[1][0] = std::numeric_limits<double>::quiet_NaN();
      if (fault == 1) slot.series[1][0] = 1.5;
      if (fault == 2) slot.kinds = kindsOf(trackChannels(CommandKind::kTrackSpeed));
      if (fault == 3) slot.period_us = 33'000;
      world.bridge.receive(program, world.now + 1);
      CHECK(timeToZero(world) == BridgeWorld::kStep);
      CHECK(world.state() == BridgeState::kDisarmed);
      CHECK(world.reason().rfind("PROGRAM with a", 0) == 0);
    }
  }
}

TEST_CASE("a planner that was restarted while driving is a reason to stop, armed again it drives") {
  BridgeWorld world;
  world.drive();
  world.planner = EndlessPlanner(2);
  CHECK(timeToZero(world) <= 60'000);
  CHECK(world.reason() == "the planner was restarted while armed");
  CHECK(world.state() == BridgeState::kDisarmed);
  world.run(1'300'000);
  world.arm();
  world.run(200'000);
  CHECK(world.state() == BridgeState::kDriving);
  CHECK(world.out.run_id == 2);
}

TEST_CASE("two planners at once can never be armed") {
  BridgeWorld world;
  EndlessPlanner second(2);
  for (int i = 0; i < 1'000; ++i) {
    world.run(50'000);
    world.bridge.receive(second.plan(world.now + 1, newest(world.bridge.executions())),
                         world.now + 1);
    world.arm();
    CHECK(world.state() == BridgeState::kDisarmed);
  }
}

TEST_CASE("a planner that talks about another execution does not keep the robot moving") {
  BridgeWorld world;
  world.planner.commands = 200;
  world.drive();
  world.planner_alive = false;
  const int64_t from = world.now;
  while (world.state() == BridgeState::kDriving && world.now - from < 1'000'000) {
    world.step();
    world.bridge.receive(makeProgram(world.now, makeSlot(900, 20)), world.now);
  }
  CHECK(world.now - from <= 210'000);
  CHECK(world.bridge.counters().at("PROGRAM refused: running slot is neither played nor pending") >
        10);
}

TEST_CASE("a bridge that was held up stops and says so") {
  BridgeWorld world;
  world.drive();
  world.now += 200'000;
  world.bridge.receive(InsNotice{world.now, true}, world.now);
  world.bridge.receive(world.planner.plan(world.now, newest(world.bridge.executions())), world.now);
  world.step();
  CHECK(isZero(world.out.command));
  CHECK(world.state() == BridgeState::kFault);
  CHECK(world.reason() ==
        "motor_bridge was held up for 210 ms: too much runs on this computer, or it was halted");
}

TEST_CASE("disarming and late copies of an old ARM") {
  BridgeWorld world;
  world.drive();
  const ArmRequest arm{world.now + 1, true, "operator", "again"};
  world.bridge.receive(arm, world.now + 1);
  world.step();
  world.bridge.receive(ArmRequest{world.now, false, "operator", "stop"}, world.now);
  world.step();
  CHECK(world.state() == BridgeState::kDisarmed);
  CHECK(world.reason() == "disarmed by operator");
  world.run(1'200'000);
  world.bridge.receive(arm, world.now);
  world.step();
  CHECK(world.state() == BridgeState::kDisarmed);
}

TEST_CASE("an ARM given before the bridge started does not arm it, one given after it does") {
  BridgeWorld world;
  const int64_t before = world.now - 100'000;
  world.step();
  const int64_t after = world.now + 1;
  world.run(1'200'000);
  for (const int64_t given : {before, after}) {
    world.bridge.receive(ArmRequest{given, true, "operator", "go"}, world.now);
    world.step();
    CHECK(isArmed(world.state()) == (given == after));
  }
}

TEST_CASE("commands leave at 50 Hz, on every change, and zero at 10 Hz a while after a stop") {
  BridgeWorld world;
  world.drive();
  Command sent = world.out.command;
  int sends = 0;
  for (int i = 0; i < 1'000; ++i) {
    world.step();
    const bool changed = world.out.command != sent;
    REQUIRE((world.out.send || !changed));
    sends += world.out.send;
    sent = world.out.send ? world.out.command : sent;
  }
  CHECK(sends >= 500);
  world.bridge.receive(ArmRequest{world.now, false, "operator", "stop"}, world.now);
  int fast = 0;
  int slow = 0;
  for (int i = 0; i < 200; ++i) {
    world.step();
    (i < 100 ? fast : slow) += world.out.send;
  }
  CHECK(fast == 50);
  CHECK(slow == 10);
}

TEST_CASE("an INS driver that is back within its limit is no reason to drive on: ARM is needed") {
  BridgeWorld world;
  world.drive();
  world.run(1'000'000);
  REQUIRE(world.state() == BridgeState::kDriving);
  world.ins_alive = false;
  world.run(70'000);
  world.ins_alive = true;
  world.ins_seq = 0;
  CHECK(timeToZero(world) <= 30'000);
  CHECK(world.reason() == "the INS driver has been restarted");
  world.run(10'000'000);
  CHECK(world.state() == BridgeState::kDisarmed);
  world.arm();
  world.run(100'000);
  CHECK(world.state() == BridgeState::kDriving);
}
