// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// With the emulated controller, which another author wrote from the protocol's documents.
#include <cmath>
#include <random>

#include <catch2/catch.hpp>

#include "modules/motor_bridge/roboteq/roboteq_connection.hpp"
#include "modules/simulator/emulators/roboteq/roboteq_emulator.hpp"
#include "tests/motor_bridge/emulated_rig.hpp"

using namespace tread;
using namespace tread::motor;

namespace {

using Rig = EmulatedRig<RoboteqConnection, sim::RoboteqEmulator>;
}  // namespace

TEST_CASE("emulated controller: started up, it gets what is played, and every line is answered") {
  sim::RoboteqSettings settings;
  settings.encoders = true;
  RoboteqConfig config;
  config.layout.rpm_per_mps = settings.rpm_per_speed;
  Rig rig(config, settings);
  sim::DriveMeasurements measured;
  measured.battery_voltage = 24.3;
  measured.motor_current = {5.5, 6.5};
  measured.track_speed = {0.8, -0.4};
  rig.device.measure(measured);
  rig.drive();
  rig.run(10'000'000);
  REQUIRE(rig.state() == BridgeState::kDriving);
  CHECK(rig.device.output(rig.now)[0] == Approx(rig.out.command[0]).margin(0.0006));
  CHECK(rig.device.output(rig.now)[1] == Approx(rig.out.command[1]).margin(0.0006));
  const MotorTelemetry telemetry = rig.connection.telemetry();
  CHECK(telemetry.battery_voltage == Approx(24.3));
  CHECK(telemetry.current[0] == Approx(5.5));
  CHECK(telemetry.measured[0] == Approx(0.8).margin(0.002));
  CHECK(telemetry.measured[1] == Approx(-0.4).margin(0.002));
  CHECK(rig.count("replies missing") == 0);
  CHECK(rig.count("unexpected replies") == 0);
  CHECK(rig.count("unreadable lines") == 0);
  CHECK(rig.count("commands refused") == 0);
  CHECK(rig.count("start-ups") == 1);
}

TEST_CASE(
    "emulated controller without encoders: two-line commands, refused speed queries stop nobody") {
  RoboteqConfig config;
  config.layout.both_in_one_line = false;
  config.layout.rpm_per_mps = 400.0;
  Rig rig(config);
  rig.drive();
  rig.run(5'000'000);
  CHECK(rig.state() == BridgeState::kDriving);
  CHECK(rig.turning());
  CHECK(rig.count("queries refused") > 10);
  CHECK(std::isnan(rig.connection.telemetry().measured[0]));
}

TEST_CASE("emulated controller: planner dead, bridge dead, controller silent: zero in time") {
  Rig rig{RoboteqConfig{}};
  rig.planner.commands = 200;
  rig.drive();
  REQUIRE(rig.turning());
  SECTION("planner") {
    rig.planner_alive = false;
    CHECK(rig.lastMotionWithin(2'000'000) <= 215'000);
  }
  SECTION("bridge") {
    rig.bridge_alive = false;
    CHECK(rig.lastMotionWithin(2'000'000) <= 252'000);
  }
  SECTION("controller") {
    rig.device.setSilent(true);
    CHECK(rig.lastMotionWithin(2'000'000) <= 252'000);
    CHECK(rig.state() == BridgeState::kFault);
    rig.device.setSilent(false);
    rig.run(3'000'000);
    CHECK(rig.now - rig.last_motion >= 4'000'000);
    rig.drive();
    CHECK(rig.state() == BridgeState::kDriving);
  }
}

TEST_CASE("emulated controller: an undervoltage is told within 40 ms, at any moment") {
  Rig rig{RoboteqConfig{}};
  rig.planner.commands = 200;
  rig.drive();
  int64_t longest = 0;
  for (int i = 0; i < 40; ++i) {
    rig.run(1'300'000 + 10'000 * i);
    rig.bridge.receive(ArmRequest{rig.now, true, "operator", "go"}, rig.now);
    rig.run(300'000);
    REQUIRE(rig.state() == BridgeState::kDriving);
    const int64_t low = rig.now;
    rig.device.setBrownOut(true);
    while (rig.state() != BridgeState::kFault && rig.now - low < 1'000'000) rig.step();
    longest = std::max(longest, rig.now - low);
    rig.device.setBrownOut(false);
  }
  CHECK(longest <= 40'000);
}

TEST_CASE("a line that loses a tenth of its bytes is told, a sound one is not") {
  Rig rig{RoboteqConfig{}};
  rig.drive();
  rig.run(10'000'000);
  CHECK(rig.connection.lineProblem().empty());
  rig.lost_bytes = 0.1;
  std::string told;
  for (int i = 0; i < 1'000 && told.empty(); ++i) {
    rig.step();
    told = rig.connection.lineProblem();
  }
  CHECK_THAT(told, Catch::Contains("% of the exchanges with the controller failed") &&
                       Catch::Contains("check cable, plugs and earthing"));
  rig.lost_bytes = 0.0;
  rig.run(12'000'000);
  CHECK(rig.connection.lineProblem().empty());
}

TEST_CASE("emulated controller: reboot and brown-out stop, afterwards it drives only after ARM") {
  Rig rig{RoboteqConfig{}};
  rig.drive();
  SECTION("reboot") {
    rig.device.reboot(rig.now);
    CHECK(rig.lastMotionWithin(3'000'000) <= 10'000);
    CHECK(rig.state() == BridgeState::kFault);
    CHECK(rig.count("start-ups") == 2);
  }
  SECTION("brown-out") {
    rig.device.setBrownOut(true);
    rig.run(1'000'000);
    CHECK(rig.state() == BridgeState::kFault);
    CHECK(rig.out.failsafe.reason.rfind("controller: undervoltage", 0) == 0);
    rig.device.setBrownOut(false);
    rig.last_motion = 0;
    rig.run(3'000'000);
    CHECK(rig.last_motion == 0);
  }
  rig.drive();
  CHECK(rig.state() == BridgeState::kDriving);
  CHECK(rig.turning());
}

TEST_CASE("emulated controller: its emergency stop is held and released, and nothing jumps") {
  Rig rig{RoboteqConfig{}};
  rig.drive();
  rig.bridge.receive(EstopRequest{rig.now, true, "operator", "person"}, rig.now);
  CHECK(rig.lastMotionWithin(2'000'000) <= 15'000);
  CHECK(rig.connection.report(rig.now).stop_latched);
  CHECK(rig.state() == BridgeState::kEstop);
  rig.bridge.receive(EstopRequest{rig.now, false, "operator", "clear"}, rig.now);
  rig.last_motion = 0;
  rig.run(2'000'000);
  CHECK_FALSE(rig.connection.report(rig.now).stop_latched);
  CHECK(rig.last_motion == 0);
  rig.drive();
  CHECK(rig.state() == BridgeState::kDriving);
}

TEST_CASE("emulated controller: lost and cut replies at random for ten minutes stop nobody") {
  std::mt19937_64 random(3);
  Rig rig{RoboteqConfig{}};
  rig.drive();
  for (int i = 0; i < 600; ++i) {
    rig.run(1'000'000);
    if (random() % 2 == 0) {
      rig.device.loseReplies(static_cast<int>(1 + random() % 3));
    } else {
      rig.device.cutReply();
    }
  }
  CHECK(rig.state() == BridgeState::kDriving);
  CHECK(rig.count("start-ups") == 1);
  CHECK(rig.count("replies missing") > 300);
}
