// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>

#include "modules/motor_bridge/motor_bridge_node.hpp"
#include "modules/motor_bridge/roboteq/roboteq_connection.hpp"

using namespace tread;
using namespace tread::motor;

namespace {

/// As if it were next to the shipped files.
const std::string kFolder = TREAD_SOURCE_DIR "/config/robots/teodor/";

MotorBridgeConfig read(const std::string& text) {
  ConfigReader reader = ConfigReader::fromText(text, kFolder + "bridge.yaml");
  return readMotorBridgeConfig(reader);
}

/// The error line for a text; empty if it is accepted.
std::string refusal(const std::string& text) {
  try {
    read(text);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "";
}

}  // namespace

TEST_CASE("without a word the bridge has its defaults, and says all of them") {
  const MotorBridgeConfig config = read("{}");
  CHECK(config.bridge.step_us == 10'000);
  CHECK(config.bridge.gate.lease_us == 200'000);
  CHECK(config.bridge.gate.slot.channels == trackChannels(CommandKind::kPower));
  for (const char* key : {"address", "lease", "ins_period", "watchdog", "left_channel"})
    CHECK(config.effective.find(key) != std::string::npos);
}

TEST_CASE("a car is steered through vesc only, and a hand at the stick drives it, too") {
  const std::string car = "robot: ../../../tests/data/robots/car/robot.yaml\n";
  CHECK(refusal(car + "controller: roboteq").find("roboteq cannot steer a car") !=
        std::string::npos);
  CHECK(refusal(car + "controller: vesc_can").find("take vesc") != std::string::npos);
  const MotorBridgeConfig config = read(car + "controller: vesc");
  CHECK(describe(config.bridge.gate.slot.channels) == "throttle [1], steering [rad]");
  const MotionLimits& motion = config.bridge.motion;
  CHECK(commandOf({0.5, 0.5}, config.bridge.manual) == Command(0.5, 0.0));
  CHECK(commandOf({0.0, 0.5}, config.bridge.manual) == Command(0.25, 0.25));
  CHECK(commandOf({0.0, 0.5}, read("{}").bridge.manual) == Command(0.0, 0.5));
  const TrackCommand wheels = motion.motion({1.0, 0.5}).tracks();
  CHECK(wheels.left == Approx(1.0 - 0.35 * std::tan(0.5) / 0.9));
  CHECK(wheels.left + wheels.right == Approx(2.0));
}

TEST_CASE("everything about the controller's wiring can be told") {
  const MotorBridgeConfig config = read(R"(
address: tcp:127.0.0.1:4000
step: 0.005
command_interval: 0.025
lease: 0.1
ins_period: 0.01
controller: roboteq
roboteq:
  watchdog: 0.2
  both_in_one_line: false
  rpm_per_mps: 400
robot:
  name: other
  outline: {front: 1, rear: 1, half_width: 0.5}
  footprint: {front: 1, rear: 1, half_width: 0.5}
  height: 1
  gauge: 1
  drive: {kind: track_speed, full_speed: 2.5, max_command: 2, left_channel: 2, invert_left: true}
  ins: {antenna: [0, 0, 0]}
  range_finder: {position: [0, 0, 0]}
  limits: {speed: 9, roll: 40, pitch: 20, pitch_rate: 90}
)");
  CHECK(config.bridge.gate.slot.step_us == 5'000);
  CHECK(config.bridge.command_interval_us == 25'000);
  CHECK(config.bridge.gate.slot.channels.front().kind == CommandKind::kTrackSpeed);
  CHECK(config.bridge.gate.slot.channels.back().highest == 2.0);
  CHECK(config.make_controller());
  REQUIRE(config.bridge.tilt);
  CHECK(config.bridge.tilt->roll == Approx(40 * kPi / 180));
  CHECK(config.bridge.tilt->pitch == Approx(20 * kPi / 180));
  CHECK(config.bridge.tilt->pitch_rate == Approx(kPi / 2));
}

TEST_CASE("a Roboteq controller is wired as its robot is") {
  DriveDescription drive;
  drive.kind = CommandKind::kTrackSpeed;
  drive.full_speed = 2.5;
  drive.left_channel = 2;
  drive.invert_left = true;
  ConfigReader reader = ConfigReader::fromText(
      "{watchdog: 0.2, both_in_one_line: false, rpm_per_mps: 400}", "roboteq");
  const RoboteqConfig config = readRoboteqConfig(reader, drive);
  CHECK(config.layout.full_scale == 2.5);
  CHECK(config.layout.left_channel == 2);
  CHECK(config.layout.invert_left);
  CHECK_FALSE(config.layout.invert_right);
  CHECK_FALSE(config.layout.both_in_one_line);
  CHECK(config.layout.rpm_per_mps == 400.0);
  CHECK(config.watchdog_ms == 200);
}

TEST_CASE("an unknown controller is told with the known ones") {
  const std::string line = refusal("controller: robotec");
  INFO(line);
  CHECK(line.find("is roboteq meant?; allowed ") != std::string::npos);
  CHECK(line.find("line_protocol") != std::string::npos);
}

TEST_CASE("no safeguard can be switched off, and every refusal is one line with its place") {
  for (const char* text :
       {"lease: 0", "lease: 1.0", "ins_period: 0", "ins_period: 10", "roboteq: {watchdog: 0}",
        "roboteq: {watchdog: 65}", "step: 0", "command_interval: 1", "controller: robotec",
        "watchdog: 0.25", "command_interval: 0.025", "lease: .nan"}) {
    const std::string line = refusal(text);
    INFO(text << " -> " << line);
    CHECK(line.rfind(kFolder + "bridge.yaml:1", 0) == 0);
    CHECK(line.find('\n') == std::string::npos);
  }
}

TEST_CASE("the motion monitor takes the robot's description, and no value ends it") {
  const MotionLimits usual = read("{}").bridge.motion;
  CHECK(usual.gauge == 0.6);
  CHECK(usual.full_speed == 1.1);
  CHECK(usual.speed_per_command == 1.1);
  const MotionLimits ours = read("motion_monitor: {delay: 0.4, least_travel: 0.3}").bridge.motion;
  CHECK(ours.delay == 0.4);
  CHECK(ours.least_travel == 0.3);
  for (const char* wide : {"delay: 5", "lag: 10", "acceleration: 0", "least_travel: 0",
                           "least_turn: 0", "pull: 5", "dead_band: 1", "time_error: 2"}) {
    INFO(wide);
    CHECK(refusal("motion_monitor: {" + std::string(wide) + "}").find("bridge.yaml:1") !=
          std::string::npos);
  }
}

TEST_CASE("what may be done by hand follows the drive, and can be made no larger than it") {
  const ManualLimits usual = read("{}").bridge.manual;
  CHECK(usual.max_command == 0.5);
  CHECK(usual.slew == 1.0);
  CHECK(usual.lease_us == 200'000);
  CHECK(read("manual: {max_command: 0.3, slew: 2}").bridge.manual.max_command == 0.3);
  for (const char* wide : {"max_command: 1.1", "slew: 100", "lease: 0.3"}) {
    INFO(wide);
    CHECK(refusal("manual: {" + std::string(wide) + "}").find("bridge.yaml:1") !=
          std::string::npos);
  }
}
