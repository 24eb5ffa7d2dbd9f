// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Wheels of a holonomic base with the controllers that support it, each with its emulator.
#include <cmath>

#include <catch2/catch.hpp>

#include "modules/motor_bridge/line_protocol/line_connection.hpp"
#include "modules/motor_bridge/motor_bridge_node.hpp"
#include "modules/motor_bridge/vesc/vesc_connection.hpp"
#include "modules/simulator/emulators/line_protocol/mole_emulator.hpp"
#include "modules/simulator/emulators/vesc/vesc_emulators.hpp"

using namespace tread;
using namespace tread::motor;
using Catch::Contains;

namespace {

const std::string kOmniFolder = TREAD_SOURCE_DIR "/tests/data/robots/omni3/";

MotorBridgeConfig omniConfig(const std::string& more = "") {
  const std::string text = "robot: " + kOmniFolder + "robot.yaml\n" +
                           (more.empty() ? "controller: vesc\nvesc: {pole_pairs: 7, gear_ratio: "
                                           "7.48, wheel_radius: 0.1}\n"
                                         : more);
  ConfigReader reader = ConfigReader::fromText(text, kOmniFolder + "motor_bridge.yaml");
  return readMotorBridgeConfig(reader);
}

std::string omniRefusal(const std::string& more) {
  try {
    omniConfig(more);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

/// Sends a command for 2 s at 100 Hz.
template <class Device>
void holdCommand(MotorController& connection, Device& device, const Command& command,
                 int64_t& now) {
  for (const int64_t end = now + 2'000'000; now < end; now += 10'000) {
    if (!connection.isOpen()) connection.open();
    connection.receive(device.transmit(now), now);
    connection.command(command, now);
    device.receive(connection.poll(now), now);
    device.output(now);
  }
}

Command threeRims(double first, double second, double third) {
  Command command(first, second);
  command[2] = third;
  return command;
}

}  // namespace

TEST_CASE("VESCs hold the rims of a holonomic base's wheels, an inverted one the other way") {
  sim::VescSettings settings;
  settings.controllers = 3;
  settings.channels = 3;
  sim::VescUartEmulator device(settings);
  const std::unique_ptr<MotorController> connection = omniConfig().make_controller();
  sim::DriveMeasurements measured;
  measured.motor_current = {1.0, 2.0, 3.0};
  measured.track_speed = {0.2, 0.3, -0.4};
  device.measure(measured);
  int64_t now = 10'000'000;
  holdCommand(*connection, device, threeRims(0.5, -0.25, 1.0), now);
  REQUIRE(connection->ready());
  const sim::MotorValues held = device.heldSpeeds().value();
  CHECK(held[0] == Approx(0.5).epsilon(1e-3));
  CHECK(held[1] == Approx(0.25).epsilon(1e-3));  // its motor is mounted in reverse
  CHECK(held[2] == Approx(1.0).epsilon(1e-3));
  const MotorTelemetry told = connection->telemetry();
  CHECK(told.measured[0] == Approx(0.2).epsilon(0.01));
  CHECK(told.measured[1] == Approx(-0.3).epsilon(0.01));
  CHECK(told.measured[2] == Approx(-0.4).epsilon(0.01));
  CHECK(told.current[2] == Approx(3.0).margin(0.11));
  holdCommand(*connection, device, {}, now);
  CHECK(device.heldSpeeds().value() == sim::MotorValues{});
}

TEST_CASE("a described controller drives three wheels and reads them back") {
  sim::MoleEmulator device(3);
  const std::string description = TREAD_SOURCE_DIR "/tests/data/controllers/mole_wheels.yaml";
  const std::unique_ptr<MotorController> connection =
      omniConfig("controller: line_protocol\nline_protocol: " + description + "\n")
          .make_controller();
  sim::DriveMeasurements measured;
  measured.motor_current = {1.0, 2.0, 3.0};
  measured.track_speed = {0.2, 0.3, -0.4};
  device.measure(measured);
  int64_t now = 10'000'000;
  holdCommand(*connection, device, threeRims(0.6, -0.3, 1.2), now);
  REQUIRE(connection->ready());
  const sim::MotorValues output = device.output(now);
  CHECK(output[0] == Approx(0.5).epsilon(1e-3));  // of the full speed, 1.2 m/s
  CHECK(output[1] == Approx(0.25).epsilon(1e-3));
  CHECK(output[2] == Approx(1.0).epsilon(1e-3));
  const MotorTelemetry told = connection->telemetry();
  CHECK(told.measured[1] == Approx(-0.3).epsilon(0.01));
  CHECK(told.measured[2] == Approx(-0.4).epsilon(0.01));
  CHECK(told.current[1] == Approx(2.0));
  // Its watchdog stops all wheels.
  CHECK(device.output(now + 1'000'000) == sim::MotorValues{});
}

TEST_CASE("what cannot drive a holonomic base's wheels is refused with what can") {
  CHECK_THAT(omniRefusal("controller: roboteq\n"),
             Contains("roboteq drives two tracks") && Contains("3 wheels") &&
                 Contains("take vesc, vesc_can or line_protocol"));
  const std::string geared = "pole_pairs: 7, gear_ratio: 7.48, wheel_radius: 0.1";
  CHECK_THAT(omniRefusal("controller: vesc\nvesc: {wheels: [1, 2], " + geared + "}\n"),
             Contains("wheels"));
  CHECK_THAT(omniRefusal("controller: vesc\nvesc: {wheels: [1, 2, 2], " + geared + "}\n"),
             Contains("names a controller twice"));
  CHECK_THAT(omniRefusal("controller: vesc\nvesc: {left: [1], " + geared + "}\n"),
             Contains("left"));
  const std::string tracks = TREAD_SOURCE_DIR "/tests/data/controllers/mole.yaml";
  CHECK_THAT(omniRefusal("controller: line_protocol\nline_protocol: " + tracks + "\n"),
             Contains("{left} is not known here"));
}

TEST_CASE(
    "the bridge of a holonomic base takes commands to its wheels, and a stick as two tracks") {
  const BridgeConfig config = omniConfig().bridge;
  CHECK(describe(config.gate.slot.channels) == "wheel1 [m/s], wheel2 [m/s], wheel3 [m/s]");
  const OmniWheels& omni = config.motion.wheels;
  const Command aside = config.motion.motion(omni.speeds({0.0, 0.6, 0.0}));
  CHECK(aside[0] == Approx(0.0).margin(1e-9));
  CHECK(aside[1] == Approx(0.0).margin(1e-9));
  CHECK(aside[kSideways] == Approx(0.6));
  const Command arc = config.motion.motion(omni.speeds({0.5, 0.0, 0.5}));
  CHECK(arc[0] == Approx(0.5 - 0.42 * 0.5));
  CHECK(arc[1] == Approx(0.5 + 0.42 * 0.5));
  // Half of max_command under manual control: ahead, and on the spot.
  const double most = config.manual.max_command;
  const Twist2 ahead = omni.twist(commandOf({most, most}, config.manual));
  CHECK(ahead.v_x == Approx(most));
  CHECK(ahead.v_y == Approx(0.0).margin(1e-9));
  CHECK(ahead.omega == Approx(0.0).margin(1e-9));
  const Twist2 spot = omni.twist(commandOf({-most, most}, config.manual));
  CHECK(spot.omega == Approx(most / 0.42));
  const Command both = commandOf({0.0, most}, config.manual);
  for (size_t i = 0; i < 3; ++i) CHECK(std::abs(both[i]) <= most + 1e-12);
}
