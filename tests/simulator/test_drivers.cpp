// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Drivers and emulators, written independently of each other from the devices' documents.
#include <cmath>
#include <map>
#include <memory>

#include <catch2/catch.hpp>

#include "common/geometry/se3.hpp"
#include "modules/ins_driver/nmea/nmea_ins.hpp"
#include "modules/motor_bridge/motor_bridge_node.hpp"
#include "modules/motor_bridge/roboteq/roboteq_connection.hpp"
#include "modules/simulator/emulators/roboteq/roboteq_emulator.hpp"
#include "modules/simulator/emulators/simulated_devices.hpp"
#include "tests/simulator/shipped_robot.hpp"

namespace tread::sim {
namespace {

constexpr int64_t kStart = 1'000'000;
constexpr int64_t kStep = 2000;

/// The robot on hilly ground, between the two drivers' cores.
struct Loop {
  Loop() : devices(world(), settings()), ins(insConfig()), motor(motor::RoboteqConfig{}) {
    motor.open();
  }

  static std::shared_ptr<const World> world() {
    WorldDescription description;
    description.terrain.waves = {{0.3, {0.3, 0.1}, 0.0}, {0.2, {-0.1, 0.4}, 1.0}};
    return std::make_shared<const World>(description);
  }
  static SimulatorSettings settings() {
    SimulatorSettings settings;
    settings.robot = shippedRobot();
    settings.robot.start_utime = kStart;
    settings.robot.start = {2.0, 3.0, 2.0};
    settings.robot.ins.position_bias = 0.0;
    settings.robot.ins.heading_bias = 0.0;
    return settings;
  }
  static ins::InsConfig insConfig() {
    const SimulatorSettings settings = Loop::settings();
    ins::InsConfig config;
    config.origin = ins::GeoOrigin{};
    config.origin->point = {settings.ins.origin_latitude * kPi / 180.0,
                            settings.ins.origin_longitude * kPi / 180.0};
    config.origin->altitude = settings.ins.origin_height - settings.ins.geoid_separation;
    config.latency_us = settings.robot.ins.latency_us;
    return config;
  }

  /// One step of 2 ms; a command every 20 ms once the controller is ready.
  void step(const TrackCommand& command) {
    now += kStep;
    devices.advanceTo(now);
    track[now] = devices.robot().truth();
    devices.motor().receive(motor.poll(now), now);
    const std::string reply = devices.motor().transmit(now);
    if (!reply.empty()) motor.receive(reply, now);
    if (now % 20000 == 0 && motor.ready()) motor.command(command, now);
    ins.push(devices.ins().transmit(now), now);
  }

  SimulatedDevices devices;
  ins::NmeaIns ins;
  motor::RoboteqConnection motor;
  int64_t now = kStart;
  std::map<int64_t, RobotTruth> track;
};

}  // namespace

TEST_CASE("what ins_driver reads from the emulated INS is where the simulated robot was") {
  Loop loop;
  double position = 0.0, yaw = 0.0, attitude = 0.0, velocity = 0.0, rate = 0.0;
  int count = 0;
  while (loop.now < kStart + 20000000) {
    loop.step({0.8, loop.now / 3000000 % 2 == 0 ? 0.6 : 0.9});
    while (const auto estimate = loop.ins.next(loop.now)) {
      const auto truth = loop.track.find(estimate->utime);
      if (truth == loop.track.end()) continue;  // the very first one, at the start
      const RobotTruth& there = truth->second;
      const YawPitchRoll angles = yawPitchRoll(estimate->R_map_body);
      position += (estimate->p_map_body - there.body.p_map).squaredNorm();
      yaw += std::pow(wrapAngle(angles.yaw - there.T_map_body.yaw), 2);
      attitude +=
          std::pow(angles.pitch - there.body.pitch, 2) + std::pow(angles.roll - there.body.roll, 2);
      velocity += std::pow(estimate->v_body.x() - there.v_body.v_x, 2) +
                  std::pow(estimate->v_body.y() - there.v_body.v_y, 2);
      rate += std::pow(estimate->rate_body.z() - there.v_body.omega, 2);
      CHECK(estimate->status == InsStatus::kGood);
      ++count;
    }
  }
  CHECK(count > 990);
  const ins::NmeaCounts counts = loop.ins.counts();
  CHECK(counts.decoded == counts.sentences);
  CHECK(counts.stray_bytes == 0);
  // Only the instruments' own noise: nothing is rotated, mirrored or late.
  CHECK(std::sqrt(position / count) < 0.009);
  CHECK(std::sqrt(yaw / count) < 0.0015);
  CHECK(std::sqrt(attitude / count) < 0.002);
  CHECK(std::sqrt(velocity / count) < 0.02);
  CHECK(std::sqrt(rate / count) < 0.004);
}

TEST_CASE("motor_bridge starts the emulated controller up, drives it and reads its battery") {
  Loop loop;
  while (!loop.motor.ready() && loop.now < kStart + 1000000) loop.step({});
  REQUIRE(loop.motor.ready());
  for (int i = 0; i < 1000; ++i) loop.step({0.7, 0.7});
  CHECK(loop.devices.motor().output(loop.now) == MotorValues{0.7, 0.7});
  CHECK(loop.devices.robot().truth().distance > 1.0);
  const auto telemetry = loop.motor.telemetry();
  CHECK(telemetry.battery_voltage ==
        Approx(loop.devices.robot().vehicle().battery().voltage).margin(0.1));
  CHECK((telemetry.device_flags & 0xff) == 0);
}

TEST_CASE(
    "after a reboot of the controller motor_bridge starts it up anew and it stood meanwhile") {
  Loop loop;
  for (int i = 0; i < 500; ++i) loop.step({0.7, 0.7});
  dynamic_cast<RoboteqEmulator&>(loop.devices.motor()).reboot(loop.now);
  CHECK(loop.devices.motor().output(loop.now) == MotorValues{0.0, 0.0});
  bool lost = false;
  for (int i = 0; i < 2000; ++i) {
    loop.step({0.7, 0.7});
    lost |= !loop.motor.ready();
  }
  CHECK(lost);
  CHECK(loop.motor.ready());
  CHECK(loop.devices.motor().output(loop.now) == MotorValues{0.7, 0.7});
}

TEST_CASE("every emulated controller lets its driver drive the simulated robot, by its name") {
  CHECK(emulatedDevices().controllers == std::vector<std::string>{"kangaroo", "line_protocol",
                                                                  "roboteq", "sabertooth", "vesc",
                                                                  "vesc_can"});
  for (const std::string& name : emulatedDevices().controllers) {
    CAPTURE(name);
    SimulatorSettings settings = Loop::settings();
    settings.controller = name;
    SimulatedDevices devices(Loop::world(), settings);
    ConfigReader reader = ConfigReader::fromText(
        "{controller: " + name + ", line_protocol: controllers/mole.yaml, sabertooth: {}, " +
            "kangaroo: {units_per_metre: 1000}}",
        TREAD_SOURCE_DIR "/tests/data/bridge.yaml");
    DriveDescription drive;
    if (name == "kangaroo") drive.kind = CommandKind::kTrackSpeed;
    drive.full_speed = drive.max_command = 1.1;
    std::string read;
    const auto motor = motor::readMotorController(reader, drive, read)();
    CHECK(read == name);
    motor->open();
    for (int64_t now = kStart; now < kStart + 5'000'000; now += kStep) {
      devices.advanceTo(now);
      devices.motor().receive(motor->poll(now), now);
      motor->receive(devices.motor().transmit(now), now);
      if (now % 20'000 == 0) motor->command({0.7, 0.7}, now);
    }
    CHECK(motor->ready());
    CHECK(motor->report(kStart + 5'000'000).device_fault.empty());
    CHECK(devices.robot().truth().distance > 2.0);
  }
}

}  // namespace tread::sim
