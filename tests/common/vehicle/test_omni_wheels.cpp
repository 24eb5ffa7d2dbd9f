// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>

#include <catch2/catch.hpp>

#include "common/config/config_reader.hpp"
#include "common/geometry/degrees.hpp"
#include "common/vehicle/kernel.hpp"
#include "common/vehicle/model_file.hpp"
#include "common/vehicle/omni_kernel.hpp"
#include "common/vehicle/omni_wheels_file.hpp"
#include "common/vehicle/robot_description.hpp"

using namespace tread;
using Catch::Contains;

namespace {

const std::string kFolder = TREAD_SOURCE_DIR "/tests/data/robots/omni3/";

OmniWheels wheelsOf(const std::string& text) {
  ConfigReader reader = ConfigReader::fromText(text, "robot.yaml");
  OmniWheels wheels = readOmniWheels(reader);
  reader.finish();
  return wheels;
}

std::string refusalOf(const std::string& text) {
  try {
    wheelsOf(text);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

const std::string kThree =
    "wheels:\n"
    "- {angle: 60, distance: 0.125}\n"
    "- {angle: 180, distance: 0.125}\n"
    "- {angle: 300, distance: 0.125}\n";

/// Four mecanum wheels at the corners of 0.6 x 0.4 m, rollers as an X seen from above.
const std::string kMecanum =
    "wheels:\n"
    "- {position: [0.3, 0.2], rollers: -45}\n"
    "- {position: [0.3, -0.2], rollers: 45}\n"
    "- {position: [-0.3, 0.2], rollers: 45}\n"
    "- {position: [-0.3, -0.2], rollers: -45}\n";

VehicleModel omniModel() {
  return readModelFile(kFolder + "model.yaml");
}

/// Held for a time [s] from a steady command on, in steps of 50 ms.
Pose2 endOfHeld(const VehicleModel& model, const Command& entry, const Command& held,
                double seconds) {
  const std::vector<Command> commands(static_cast<size_t>(std::lround(seconds / 0.05)), held);
  return simulateFrom(model, entry, commands, 0.05).back();
}

}  // namespace

TEST_CASE("three omni wheels turn as their equation says, and twists come back from rim speeds") {
  const OmniWheels wheels = wheelsOf(kThree);
  REQUIRE(wheels.size() == 3);
  const Twist2 twist{0.3, -0.2, 0.7};
  const Command speeds = wheels.speeds(twist);
  for (size_t i = 0; i < 3; ++i) {
    const double a = toRadians(60.0 + 120.0 * static_cast<double>(i));
    CHECK(speeds[i] ==
          Approx(-std::sin(a) * twist.v_x + std::cos(a) * twist.v_y + 0.125 * twist.omega));
  }
  const Twist2 back = wheels.twist(speeds);
  CHECK(back.v_x == Approx(twist.v_x));
  CHECK(back.v_y == Approx(twist.v_y));
  CHECK(back.omega == Approx(twist.omega));
  CHECK(wheels.radius() == Approx(0.125));
  // Two wheels that push at 30 degrees to the path need at least 1/cos(30) times its speed.
  CHECK(wheels.reach() > 1.15);
  CHECK(wheels.reach() < 2.0);
}

TEST_CASE("mecanum wheels are told by the angle of their rollers") {
  const OmniWheels wheels = wheelsOf(kMecanum);
  const Command ahead = wheels.speeds({0.5, 0.0, 0.0});
  for (size_t i = 0; i < 4; ++i) CHECK(ahead[i] == Approx(0.5));
  const Command left = wheels.speeds({0.0, 0.5, 0.0});
  CHECK(left[0] == Approx(-0.5));
  CHECK(left[1] == Approx(0.5));
  CHECK(left[2] == Approx(0.5));
  CHECK(left[3] == Approx(-0.5));
  const Command turn = wheels.speeds({0.0, 0.0, 1.0});
  CHECK(turn[0] == Approx(-0.5));  // half of length plus width
  CHECK(turn[1] == Approx(0.5));
  CHECK(turn[2] == Approx(-0.5));
  CHECK(turn[3] == Approx(0.5));
  // Contradicting wheels: the least-squares motion.
  CHECK(wheels.twist(Command(1.0, 0.0)).v_x == Approx(0.25));
}

TEST_CASE("wheels that cannot move a base in all directions are refused with what is wrong") {
  CHECK_THAT(refusalOf("wheels: [{angle: 0, distance: 0.3}, {angle: 120, distance: 0.3}]"),
             Contains("robot.yaml:1") && Contains("wheels") &&
                 Contains("2 wheels; forward, sideways and yaw need 3 to 8"));
  CHECK_THAT(refusalOf("wheels:\n- {position: [0.3, 0.2]}\n- {position: [0.3, -0.2]}\n"
                       "- {position: [-0.3, 0]}\n"),
             Contains("cannot move it forwards, sideways and turn it independently"));
  CHECK_THAT(refusalOf("wheels:\n- {position: [0, 0], heading: 0}\n"
                       "- {position: [0, 0], heading: 120}\n- {position: [0, 0], heading: 240}\n"),
             Contains("cannot move it"));
  const std::string radians = refusalOf(
      "wheels:\n- {angle: 1.0472, distance: 0.3}\n- {angle: 3.1416, distance: 0.3}\n"
      "- {angle: 5.236, distance: 0.3}\n");
  CHECK_THAT(radians, Contains("angles are in degrees, these look like radians"));
  CHECK_THAT(refusalOf("wheels:\n- {angle: 60, distance: 0.3}\n- {angle: 180}\n"),
             Contains("distance"));
  CHECK_THAT(refusalOf("wheels:\n- {angle: 60, distance: 0.3, position: [0, 1]}\n"),
             Contains("give one of them"));
  CHECK_THAT(refusalOf("wheels:\n- {angle: 60, distance: 0.3, rollers: 90}\n"),
             Contains("rollers"));
  CHECK_THAT(refusalOf("wheels:\n- {angle: 600, distance: 0.3}\n"), Contains("angle"));
}

TEST_CASE("a robot with layout omni commands its wheels, and needs no gauge") {
  ConfigReader reader = ConfigReader::fromText("{}", kFolder + "planner.yaml");
  const RobotDescription robot = readRobot(reader);
  CHECK(robot.drive.isOmni());
  CHECK(robot.gauge == Approx(0.84));
  const CommandChannels channels = robot.drive.channels();
  REQUIRE(channels.size() == 3);
  CHECK(channels[2].name == "wheel3");
  CHECK(channels[2].kind == CommandKind::kTrackSpeed);
  CHECK(channels[2].highest == 1.2);
  CHECK(robot.drive.invert_wheels == std::vector<bool>{false, true, false});
  CHECK(robot.drive.topSpeed() > 1.2);
  const std::string logged = reader.effective();
  ConfigReader again = ConfigReader::fromText(logged, "CONFIG of a log");
  CHECK(readRobot(again).drive.wheels.size() == 3);
}

TEST_CASE("a holonomic base drives forwards, sideways and turns on the spot as its gains say") {
  VehicleModel model = omniModel();
  model.sideways_gain = 0.5;
  const OmniWheels& wheels = model.wheels;
  const Command ahead = wheels.speeds({0.8, 0.0, 0.0}), left = wheels.speeds({0.0, 0.6, 0.0});
  const Command turn = wheels.speeds({0.0, 0.0, 0.9});
  const Pose2 forward = endOfHeld(model, ahead, ahead, 1.0);
  CHECK(forward.x == Approx(0.95 * 0.8));
  CHECK(forward.y == Approx(0.0).margin(1e-9));
  CHECK(forward.yaw == Approx(0.0).margin(1e-9));
  const Pose2 aside = endOfHeld(model, left, left, 1.0);
  CHECK(aside.x == Approx(0.0).margin(1e-9));
  CHECK(aside.y == Approx(0.5 * 0.6));
  const Pose2 spot = endOfHeld(model, turn, turn, 1.0);
  CHECK(std::hypot(spot.x, spot.y) < 1e-9);
  CHECK(spot.yaw == Approx(0.95 * 0.9));
  // From standstill delay and lag reduce it.
  const Pose2 started = endOfHeld(model, {}, ahead, 2.0);
  CHECK(started.x == Approx(0.95 * 0.8 * (2.0 - model.delay - model.lag)).epsilon(1e-3));
  const MotionClass going = classOf(model, "left", left);
  CHECK(going.twist.v_y == Approx(0.3));
  CHECK(going.twist.v_x == Approx(0.0).margin(1e-9));
}

TEST_CASE("a holonomic base's prediction has its spread, sideways as ahead") {
  const VehicleModel model = omniModel();
  MotionPattern pattern;
  const Command left = model.wheels.speeds({0.0, 0.6, 0.0});
  pattern.commands.assign(20, left);
  predict(model, 0.05, classOf(model, "left", left), pattern);
  REQUIRE(pattern.trajectory.size() == 20);
  const double length = pattern.end().y;
  CHECK(length == Approx(0.95 * 0.6));
  CHECK(std::sqrt(pattern.end_covariance[3]) == Approx(0.03 * length).epsilon(1e-3));  // along y
  CHECK(std::sqrt(pattern.end_covariance[0]) == Approx(0.02 * length).epsilon(1e-2));  // across
}

TEST_CASE("a model of a holonomic base is written as it is read, and has no effects of tracks") {
  const ModelDocument document = readModelDocument(kFolder + "model.yaml");
  const ModelDocument again = parseModelDocument(formatModelDocument(document), "again");
  REQUIRE(again.vehicle.wheels.size() == 3);
  for (size_t i = 0; i < 3; ++i) {
    const OmniWheel& a = document.vehicle.wheels.wheels()[i];
    const OmniWheel& b = again.vehicle.wheels.wheels()[i];
    CHECK((a.x == b.x && a.y == b.y && a.heading == b.heading && a.rollers == b.rollers));
  }
  CHECK(again.vehicle.sideways_gain == 0.95);
  const std::string head = "name: x\nkind: track_speed\n" + kThree;
  CHECK_THROWS_WITH(parseModelDocument(head + "gauge: 0.6\n", "m"), Contains("gauge"));
  CHECK(parseModelDocument(head + "effects: {slip_ratio: {slip: 0.1}}\n", "m")
            .vehicle.effects.slip_ratio == 0.1);
  CHECK_THROWS_WITH(parseModelDocument(head + "effects: {track_asymmetry: {share: 0.1}}\n", "m"),
                    Contains("track_asymmetry") && Contains("holonomic base"));
  CHECK_THROWS_WITH(readTrackModelDocument(kFolder + "model.yaml"),
                    Contains("model.yaml") && Contains("holonomic base"));
}
