// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Defects of motor bridges in other LCM projects; ours has none of them.
#include <catch2/catch.hpp>

#include "tests/motor_bridge/node_world.hpp"

using namespace tread;
using namespace tread::motor;

TEST_CASE("a heartbeat of anybody does not keep the last speed alive") {
  // vesc-motor-controller: every HEARTBEAT repeats the last speed, for ever.
  NodeWorld world;
  world.planner().planner.commands = 200;
  world.drive();
  world.bus.kill("planner");
  const int64_t begin = world.now();
  for (int i = 0; i < 100; ++i) {
    health_t heartbeat{};
    heartbeat.utime = world.now();
    heartbeat.process = "planner";
    world.bus.outside().publish(kHealth, heartbeat);
    world.run(20'000);
  }
  CHECK(world.moving.back() - begin <= 250'000);
}

TEST_CASE("the timeout runs without any message coming in") {
  // animatics-motor: evaluated only when a heartbeat arrives, and with a limit of 10 s.
  NodeWorld world;
  world.planner().planner.commands = 200;
  world.drive();
  world.bus.kill("planner");
  world.bus.kill("ins");
  CHECK(world.lastMotionWithin(2'000'000) <= 250'000);
}

TEST_CASE("every way to end a process in order gives zero") {
  // vesc-motor-controller: only SIGINT stops; SIGTERM leaves the motors running. Here both call
  // shutdown().
  NodeWorld world;
  world.drive();
  Bus& outside = world.bus.outside();
  motor_t last{};
  outside.subscribe<motor_t>(kMotor, [&last](const motor_t& message) { last = message; });
  world.bridge().shutdown(world.now());
  CHECK(world.lastMotionWithin(5'000) <= 2'000);
  CHECK(last.bridge_state == motor_t::STATE_DISARMED);
  CHECK(last.state_reason == "disarmed by the end of motor_bridge");
  CHECK(world.device.heard.back() == "!M 0 0");
}

TEST_CASE("ages are not the sender's: a planner with a clock of its own cannot drive") {
  // animatics-motor compares two stamps of the sender, vesc-motor-controller uses the wall clock.
  for (const int64_t offset : {-3'600'000'000LL, -300'000LL, 60'000LL, 3'600'000'000LL}) {
    NodeWorld world;
    world.bus.kill("planner");
    world.run(2'000'000);
    for (int i = 0; i < 60; ++i) {
      program_t program{};
      program.utime = world.now() + offset;
      program.seq = i;
      program.run_id = 1;
      program.lease = 200'000;
      program.running.execution_id = 1;
      program.running.num_channels = 2;
      program.running.channel_kind.assign(2, program_slot_t::KIND_POWER);
      program.running.period = 50'000;
      program.running.num_commands = 1;
      program.running.command = {{1.0F, 1.0F}};
      world.bus.outside().publish(kProgram, program);
      world.say(true);
      world.run(50'000);
    }
    CHECK(world.moving.empty());
    CHECK(world.motor.bridge_state == motor_t::STATE_DISARMED);
  }
}

TEST_CASE("the controller's own watchdog is set and read back before anything moves") {
  // Roboteq's ROS driver sets no watchdog at all.
  NodeWorld world;
  world.device.forced_watchdog = 0;
  world.run(2'000'000);
  for (int i = 0; i < 10; ++i) {
    world.say(true);
    world.run(500'000);
  }
  CHECK(world.moving.empty());
  CHECK(world.health.health_reason.find(
            "its watchdog did not take its setting: it reads 0 ms instead of 250") !=
        std::string::npos);
}

TEST_CASE("only commands feed the watchdogs: queries and other traffic do not") {
  // mbot: the time-sync message resets the timer of the motors.
  ScriptedRoboteq device;
  device.write("^ECHOF 1\r^RWD 250\r!M 500 500\r", 0);
  for (int64_t now = 0; now < 500'000; now += 10'000) device.write("?A\r?FF\r~RWD\r", now);
  CHECK(device.stands(500'000));
}

TEST_CASE("a command is looked at with its age every time it is used") {
  // Cheetah: the joystick's message is used without any age check.
  NodeWorld world;
  world.planner().planner.commands = 200;
  world.drive();
  world.bus.kill("planner");
  world.run(250'000);
  CHECK(world.motor.bridge_state == motor_t::STATE_DISARMED);
  CHECK(world.device.stands(world.now()));
}

TEST_CASE("it goes on sending zero when all its inputs are silent") {
  // twist_mux publishes only in callbacks: without inputs it sends nothing.
  NodeWorld world;
  world.drive();
  world.bus.kill("planner");
  world.bus.kill("ins");
  world.run(2'000'000);
  const size_t heard = world.device.heard.size();
  const int64_t motors = world.motors;
  world.run(10'000'000);
  const auto zeros = std::count(world.device.heard.begin() + static_cast<std::ptrdiff_t>(heard),
                                world.device.heard.end(), "!M 0 0");
  CHECK(zeros >= 99);
  CHECK(world.motors - motors >= 200);
}

TEST_CASE("a zero within the reason of an E-stop does not keep the bridge from telling its state") {
  // Tread's own, found by fuzzing: MOTOR with such a reason could not be encoded, and was not sent.
  NodeWorld world;
  world.drive();
  estop_t message{};
  message.utime = world.now();
  message.engaged = 1;
  message.estop_by = "bystander";
  message.estop_reason = "a person";
  std::vector<uint8_t> bytes(static_cast<size_t>(message.getEncodedSize()));
  message.encode(bytes.data(), 0, static_cast<int>(bytes.size()));
  bytes[bytes.size() - 4] = 0;
  world.bus.inject(kEstop.name, bytes.data(), bytes.size());
  world.run(100'000);
  const int64_t told = world.motors;
  world.run(1'000'000);
  CHECK(world.motor.bridge_state == motor_t::STATE_ESTOP);
  CHECK(world.motors >= told + 19);
}
