// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "tests/helpers.hpp"
#include "tests/motor_bridge/node_world.hpp"

using namespace tread;
using namespace tread::motor;

TEST_CASE("armed, it drives, MOTOR, EXECUTION, HEALTH and CONFIG come at their rates") {
  NodeWorld world;
  world.drive();
  REQUIRE(world.drives());
  const int64_t motors = world.motors;
  const int64_t executions = world.executions;
  world.run(10'000'000);
  CHECK(world.motors - motors >= 200);
  CHECK(world.motors - motors <= 500);
  CHECK(world.executions - executions >= 50);
  CHECK(world.health.process == "motor_bridge");
  CHECK(world.health.health_state == health_t::HEALTH_OK);
  CHECK(world.config.config_process == "motor_bridge");
  CHECK(world.motor.battery_voltage == Approx(24.6));
  CHECK(world.motor.current[1] == Approx(-0.7));
  CHECK(world.motor.channel_kind[0] == program_slot_t::KIND_POWER);
  CHECK(world.motor.execution_id == world.execution.records.back().record_execution_id);
}

TEST_CASE("the controller gets the commands of the series, and series follow without a gap") {
  NodeWorld world;
  world.drive();
  world.run(10'000'000);
  CHECK(world.moving.back() - world.moving.front() ==
        1'000 * static_cast<int64_t>(world.moving.size() - 1));
  const auto& records = world.execution.records;
  REQUIRE(records.size() == 8);
  for (size_t i = 0; i + 1 < records.size(); ++i) {
    CHECK(records[i].ended == records[i + 1].started);
    CHECK(records[i].ended - records[i].started == 400'000);
    CHECK(records[i].outcome == execution_record_t::OUTCOME_COMPLETED);
    CHECK(records[i].commands_played == 8);
  }
  CHECK(world.device.motor1(world.now()) == std::lround(1000 * world.motor.command[0]));
}

TEST_CASE("it comes up disarmed and says what is missing") {
  NodeWorld world;
  world.bus.kill("planner");
  world.run(3'000'000);
  CHECK(world.motor.bridge_state == motor_t::STATE_DISARMED);
  CHECK(world.motor.state_reason == "not armed yet; now: no PROGRAM yet");
  CHECK(world.health.health_state == health_t::HEALTH_DEGRADED);
  CHECK(world.health.health_reason == "no PROGRAM yet");
  world.say(true);
  world.run(100'000);
  CHECK(world.motor.state_reason == "not armed yet; ARM refused: no PROGRAM yet");
  CHECK(world.moving.empty());
}

TEST_CASE("planner killed: zero within the budget, and ARM is needed after its return") {
  NodeWorld world;
  world.planner().planner.commands = 100;
  world.drive();
  world.bus.kill("planner");
  CHECK(world.lastMotionWithin(3'000'000) <= 250'000);
  CHECK(world.motor.bridge_state == motor_t::STATE_DISARMED);
  world.bus.restart("planner");
  world.run(5'000'000);
  CHECK(world.stoodFor() >= 5'000'000);
  world.say(true);
  world.run(300'000);
  CHECK(world.drives());
  CHECK(world.motor.motor_run_id == world.execution.records.back().record_run_id);
}

TEST_CASE("planner restarted at once while driving: a stop with that reason") {
  NodeWorld world;
  world.drive();
  world.bus.restart("planner");
  CHECK(world.lastMotionWithin(1'000'000) <= 250'000);
  CHECK(world.motor.state_reason == "the planner was restarted while armed");
}

TEST_CASE("INS killed: zero within 110 ms of its last message") {
  NodeWorld world;
  world.drive();
  world.bus.kill("ins");
  CHECK(world.lastMotionWithin(2'000'000) <= 115'000);
  CHECK(world.motor.bridge_state == motor_t::STATE_DISARMED);
  CHECK(world.motor.state_reason.rfind("INS is stale", 0) == 0);
}

TEST_CASE("E-stop: zero at once, held in the controller, until cleared and armed") {
  NodeWorld world;
  world.drive();
  world.estop(true);
  CHECK(world.lastMotionWithin(3'000'000) <= 15'000);
  CHECK(world.motor.bridge_state == motor_t::STATE_ESTOP);
  CHECK(world.motor.state_reason == "E-stop: person in front (operator)");
  CHECK((world.device.fault_flags & 16) != 0);
  world.say(true);
  world.run(2'000'000);
  CHECK(world.motor.bridge_state == motor_t::STATE_ESTOP);
  world.estop(false);
  world.run(2'000'000);
  CHECK((world.device.fault_flags & 16) == 0);
  CHECK(world.motor.bridge_state == motor_t::STATE_DISARMED);
  world.say(true);
  world.run(300'000);
  CHECK(world.drives());
}

TEST_CASE("the controller's own E-stop button: a fault, ARM releases it, the next ARM drives") {
  NodeWorld world;
  world.drive();
  world.device.fault_flags = 16;
  world.run(2'000'000);
  CHECK(world.motor.bridge_state == motor_t::STATE_FAULT);
  CHECK(world.motor.state_reason == "controller: emergency stop");
  CHECK(world.motor.device_fault == (16 | 1 << 8));
  world.say(true);
  world.run(2'000'000);
  CHECK(world.device.fault_flags == 0);
  CHECK(world.motor.bridge_state == motor_t::STATE_FAULT);
  world.say(true);
  world.run(300'000);
  CHECK(world.drives());
}

TEST_CASE("link lost and back: the watchdog stops the motors, the bridge stays disarmed") {
  NodeWorld world;
  world.drive();
  setPipeConnected(*world.pipe.first, false);
  CHECK(world.lastMotionWithin(3'000'000) <= 255'000);
  CHECK(world.motor.bridge_state == motor_t::STATE_FAULT);
  CHECK(world.health.health_state == health_t::HEALTH_FAILED);
  setPipeConnected(*world.pipe.first, true);
  world.run(5'000'000);
  CHECK(world.stoodFor() >= 7'000'000);
  CHECK(world.device.resumed == 0);
  CHECK(world.health.health_state == health_t::HEALTH_DEGRADED);
  world.say(true);
  world.run(300'000);
  CHECK(world.drives());
}

TEST_CASE("link lost for a moment only: still a stop, zero first, ARM needed") {
  NodeWorld world;
  world.drive();
  setPipeConnected(*world.pipe.first, false);
  world.run(30'000);
  setPipeConnected(*world.pipe.first, true);
  CHECK(world.lastMotionWithin(3'000'000) <= 255'000);
  CHECK(world.motor.bridge_state == motor_t::STATE_FAULT);
}

TEST_CASE("controller switched off and on: noticed, started up anew with its watchdog, disarmed") {
  NodeWorld world;
  world.drive();
  world.device.powerCycle();
  CHECK(world.lastMotionWithin(3'000'000) <= 50'000);
  CHECK(world.motor.bridge_state == motor_t::STATE_FAULT);
  CHECK(world.device.watchdog() == 250);
  world.say(true);
  world.run(300'000);
  CHECK(world.drives());
}

TEST_CASE(
    "motor_bridge killed: the controller's watchdog stops, restarted it is disarmed, zero first") {
  NodeWorld world;
  world.drive();
  world.bus.kill("motor_bridge");
  CHECK(world.lastMotionWithin(2'000'000) <= 252'000);
  world.bus.restart("motor_bridge");
  world.run(3'000'000);
  CHECK(world.stoodFor() >= 4'000'000);
  CHECK(world.device.resumed == 0);
  CHECK(world.motor.bridge_state == motor_t::STATE_DISARMED);
  world.say(true);
  world.run(300'000);
  CHECK(world.drives());
}

TEST_CASE("a clean end gives zero at once and closes the execution") {
  NodeWorld world;
  world.drive();
  world.bridge().shutdown(world.now());
  world.bus.runUntil(world.now() + 1);
  world.bus.kill("motor_bridge");
  CHECK(world.lastMotionWithin(1'000'000) <= 2'000);
}

TEST_CASE("dropped, duplicated and reordered programs: it drives on or stops, never otherwise") {
  FaultPlan faults;
  faults.messages.push_back({"PROGRAM", "motor_bridge", 0.2, 0.2, 0.0, 0.2});
  for (uint64_t seed = 1; seed <= static_cast<uint64_t>(testing::effort(20)); ++seed) {
    NodeWorld world(seed, faults);
    int64_t newest_program = 0;
    world.bus.setTap([&](int64_t utime, const char* channel, const uint8_t*, size_t) {
      if (std::string("PROGRAM") == channel) newest_program = utime;
    });
    for (int i = 0; i < 20; ++i) world.drive();
    const int64_t driven = 1'000 * static_cast<int64_t>(world.moving.size());
    CHECK(driven > 10'000'000);
    world.bus.kill("planner");
    world.run(1'000'000);
    CHECK(world.moving.back() - newest_program <= 250'000);
  }
}

TEST_CASE("unexpected and broken messages on its channels are counted and change nothing") {
  NodeWorld world;
  world.drive();
  const std::vector<uint8_t> noise(100, 0x5a);
  for (const char* channel : {"PROGRAM", "INS", "ARM", "ESTOP"}) {
    world.bus.inject(channel, noise.data(), noise.size());
    world.bus.inject(channel, noise.data(), 0);
  }
  world.run(2'000'000);
  CHECK(world.drives());
  CHECK(world.health.undecodable == 8);
}

TEST_CASE("a bridge that needs 5 ms for a step still stops within the budget") {
  NodeWorld world(1, {}, {5'000, 0});
  world.planner().planner.commands = 100;
  world.drive();
  REQUIRE(world.drives());
  world.bus.kill("planner");
  CHECK(world.lastMotionWithin(2'000'000) <= 250'000);
}

TEST_CASE("long reasons are cut, so that MOTOR and EXECUTION always fit their channels") {
  NodeWorld world;
  world.drive();
  for (int i = 0; i < 10; ++i) {
    estop_t stop{};
    stop.utime = world.now();
    stop.engaged = true;
    stop.estop_by = "operator";
    stop.estop_reason = std::string(900, 'x');
    world.bus.outside().publish(kEstop, stop);
    world.run(1'000'000);
    world.estop(false);
    world.drive();
    REQUIRE(world.drives());
  }
  CHECK(world.bus.statistics("motor_bridge").oversized == 0);
  CHECK(world.execution.num_records == 8);
  CHECK(world.execution.records[0].outcome_reason.size() == 120);
}

TEST_CASE("refusals are counted in HEALTH with their reasons") {
  FaultPlan faults;
  faults.messages.push_back({"PROGRAM", "motor_bridge", 0.0, 0.5});
  NodeWorld world(1, faults);
  world.drive();
  world.run(5'000'000);
  CHECK(world.drives());
  CHECK(world.counter("PROGRAM refused: not newer than the one before") > 20);
  CHECK(world.counter("commands sent") > 200);
  CHECK(world.counter("replies missing") == 0);
}

TEST_CASE("same seed, same bytes on bus and line") {
  FaultPlan faults;
  faults.messages.push_back({"*", "*", 0.05, 0.05, 0.01, 0.1});
  const auto record = [&faults](uint64_t seed) {
    NodeWorld world(seed, faults);
    std::string bytes;
    world.bus.setTap([&](int64_t utime, const char* channel, const uint8_t* b, size_t size) {
      bytes += std::to_string(utime) + channel;
      bytes.append(reinterpret_cast<const char*>(b), size);
    });
    for (int i = 0; i < 5; ++i) world.drive();
    for (const std::string& line : world.device.heard) bytes += line;
    return bytes;
  };
  CHECK(record(3) == record(3));
  CHECK(record(3) != record(4));
}
