// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Controllers from descriptions with emulated ones: Roboteq's own protocol as a description, and
// an invented protocol.
#include <cmath>

#include <catch2/catch.hpp>

#include "modules/motor_bridge/line_protocol/line_connection.hpp"
#include "modules/simulator/emulators/line_protocol/mole_emulator.hpp"
#include "modules/simulator/emulators/roboteq/roboteq_emulator.hpp"
#include "tests/motor_bridge/controller_promises.hpp"

using namespace tread;
using namespace tread::motor;

namespace {

using MoleRig = EmulatedRig<LineConnection, sim::MoleEmulator>;
using RoboteqRig = EmulatedRig<LineConnection, sim::RoboteqEmulator>;

LineDescription described(const std::string& name, const DriveDescription& drive = {}) {
  ConfigReader reader =
      ConfigReader::fromFile(TREAD_SOURCE_DIR "/tests/data/controllers/" + name + ".yaml");
  const LineDescription line = readLineDescription(reader, drive);
  reader.finish();
  return line;
}

sim::DriveMeasurements someMeasurements() {
  sim::DriveMeasurements measured;
  measured.battery_voltage = 24.3;
  measured.motor_current = {5.5, -6.5};
  measured.track_speed = {0.8, -0.4};
  return measured;
}

void readsThem(const MotorTelemetry& told) {
  CHECK(told.battery_voltage == Approx(24.3));
  CHECK(told.current[0] == Approx(5.5));
  CHECK(told.current[1] == Approx(-6.5));
  CHECK(told.measured[0] == Approx(0.8).margin(0.002));
  CHECK(told.measured[1] == Approx(-0.4).margin(0.002));
}

/// A Mole's output during start-up and ten seconds of driving.
std::string talkOfMole() {
  MoleRig rig{described("mole")};
  std::string talk;
  for (int i = 0; i < 300; ++i) {
    rig.now += 10'000;
    const std::string said = rig.device.transmit(rig.now);
    talk += said;
    rig.connection.receive(said, rig.now);
    rig.connection.command({0.5, 0.5}, rig.now);
    rig.device.receive(rig.connection.poll(rig.now), rig.now);
  }
  return talk;
}

}  // namespace

TEST_CASE(
    "a described controller steers a car: the servo's counts about its centre, also at zero") {
  DriveDescription car;
  car.layout = DriveLayout::kThrottleSteering;
  car.full_speed = car.max_command = 1.0;
  car.wheelbase = 0.9;
  car.max_steering = 0.5;
  const std::string head = "name: servo car\ncommand: [\"T{throttle:+d} S{steering:04d}\"]\n";
  ConfigReader reader = ConfigReader::fromText(
      head + "full_command: 500\nsteering_centre: 1500\nfull_steering: -400\n", "car.yaml");
  LineConnection connection(readLineDescription(reader, car));
  reader.finish();
  connection.open();
  std::string sent;
  const auto run = [&](const Command& command) {
    sent.clear();
    for (int64_t now = 0; now < 1'000'000; now += 10'000) {
      connection.command(command, 10'000'000 + now);
      sent += connection.poll(10'000'000 + now);
    }
  };
  run({});
  CHECK(sent.find("T+0 S1500\r") != std::string::npos);
  CHECK(sent.find("S0000") == std::string::npos);
  run({0.5, 0.25});
  CHECK(sent.find("T+250 S1300\r") != std::string::npos);
  run({-1.0, -9.0});
  CHECK(sent.find("T-500 S1900\r") != std::string::npos);
  const auto refused = [&](const std::string& text) {
    ConfigReader bad = ConfigReader::fromText(text, "car.yaml");
    CHECK_THROWS_AS(readLineDescription(bad, car), ConfigError);
  };
  refused("name: x\ncommand: [\"M {left} {right}\"]\n");
  refused("name: x\ncommand: [\"T {throttle}\"]\n");
  refused(head + "full_steering: 0\n");
  refused("name: x\ncommand: [\"T {throttle} S {steering:04x}\"]\nfull_steering: 5\n");
}

TEST_CASE("Roboteq's own protocol is a description: it drives the emulated controller") {
  sim::RoboteqSettings settings;
  settings.encoders = true;
  RoboteqRig rig{described("roboteq"), settings};
  rig.device.measure(someMeasurements());
  rig.drive();
  rig.run(10'000'000);
  REQUIRE(rig.state() == BridgeState::kDriving);
  CHECK(rig.device.output(rig.now)[0] == Approx(rig.out.command[0]).margin(0.0006));
  CHECK(rig.device.output(rig.now)[1] == Approx(rig.out.command[1]).margin(0.0006));
  readsThem(rig.connection.telemetry());
  CHECK(rig.connection.notice().empty());
  for (const char* none : {"replies missing", "unexpected replies", "unreadable lines"})
    CHECK(rig.count(none) == 0);
  CHECK(rig.count("start-ups") == 1);
  rig.bridge.receive(EstopRequest{rig.now, true, "operator", "person"}, rig.now);
  CHECK(rig.lastMotionWithin(2'000'000) <= 15'000);
  CHECK(rig.connection.report(rig.now).stop_latched);
  rig.bridge.receive(EstopRequest{rig.now, false, "operator", "clear"}, rig.now);
  standsUntilArmed(rig, 2'000'000);
  rig.device.setBrownOut(true);
  rig.run(200'000);
  CHECK(rig.out.failsafe.reason.rfind("controller: undervoltage", 0) == 0);
}

TEST_CASE("a controller nobody has is driven by its description alone") {
  DriveDescription drive;
  drive.left_channel = 2;
  drive.invert_left = true;
  MoleRig rig{described("mole", drive)};
  rig.device.measure(someMeasurements());
  rig.drive();
  rig.run(5'000'000);
  REQUIRE(rig.state() == BridgeState::kDriving);
  CHECK(rig.device.watchdog() == 0.2);
  CHECK(rig.device.output(rig.now)[1] == Approx(-rig.out.command[0]).margin(1e-4));
  CHECK(rig.device.output(rig.now)[0] == Approx(rig.out.command[1]).margin(1e-4));
  const MotorTelemetry told = rig.connection.telemetry();
  CHECK(told.current[0] == Approx(-6.5));
  CHECK(told.measured[0] == Approx(0.4));
  CHECK(told.measured[1] == Approx(0.8));
  CHECK(told.temperature == Approx(31.0));
  for (const char* none : {"replies missing", "wrong checksums", "unreadable lines"})
    CHECK(rig.count(none) == 0);
  rig.device.setFaults(4);
  rig.run(200'000);
  CHECK(rig.out.failsafe.reason.rfind("controller: stall", 0) == 0);
}

TEST_CASE("described controllers stop in time, and nothing moves before it is armed") {
  stopsInTime([] { return MoleRig{described("mole")}; }, 200'000);
  stopsInTime([] { return RoboteqRig{described("roboteq")}; }, 250'000);
}

TEST_CASE(
    "described controller: a reboot is noticed, stall and silence too, and zero comes first") {
  MoleRig rig{described("mole")};
  requireDriving(rig);
  SECTION("reboot") {
    rig.device.reboot(rig.now);
    CHECK(rig.lastMotionWithin(3'000'000) <= 15'000);
    CHECK(rig.count("start-ups") == 2);
  }
  SECTION("silence") {
    rig.device.setSilent(true);
    CHECK(rig.lastMotionWithin(2'000'000) <= 215'000);
    CHECK(rig.count("controller lost: it does not acknowledge commands") == 1);
    rig.device.setSilent(false);
  }
  SECTION("only the bridge was silent") {
    rig.bridge_alive = false;
    rig.run(400'000);
    REQUIRE_FALSE(rig.turning());
    rig.bridge_alive = true;
  }
  CHECK(rig.device.resumed() == 0);
  rig.run(3'000'000);
  requireDriving(rig);
  CHECK(rig.device.resumed() == 0);
}

TEST_CASE("described controller: lost, cut and garbled replies are counted and stop nobody") {
  MoleRig rig{described("mole")};
  requireDriving(rig);
  for (int i = 0; i < 300; ++i) {
    rig.run(300'000);
    if (i % 3 == 0) rig.device.loseReplies(1);
    if (i % 3 == 1) rig.device.cutReply();
    if (i % 3 == 2) rig.device.garbleReply();
  }
  CHECK(rig.state() == BridgeState::kDriving);
  CHECK(rig.count("start-ups") == 1);
  CHECK(rig.count("wrong checksums") > 100);
  CHECK(rig.count("replies missing") > 100);
  rig.lost_bytes = 0.1;
  rig.run(8'000'000);
  CHECK(rig.device.resumed() == 0);
}

TEST_CASE("described controller: a million random and mutated bytes") {
  bearsRandomBytes<LineConnection>(described("mole"), talkOfMole(), 600'000);
  bearsRandomBytes<LineConnection>(described("roboteq"), "+\r-\rRWD=250\rFF=0\rV=1:2:3\rA=1:2\r",
                                   600'000);
}
