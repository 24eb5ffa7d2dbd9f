// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "modules/simulator/simulator_node.hpp"

namespace tread::sim {
namespace {

const std::string kSimulators = TREAD_SOURCE_DIR "/config/simulators/";
/// As if it were next to the shipped files.
const std::string kHere = kSimulators + "test.yaml";
const std::string kWorld =
    "world: ../worlds/meadow.yaml\nrobot: ../robots/teodor/robot.yaml\n"
    "dynamics: ../robots/teodor/dynamics.yaml\n";

SimulatorConfig read(const std::string& text, const std::vector<std::string>& overrides = {}) {
  ConfigReader reader = ConfigReader::fromText(text, kHere, overrides);
  return readSimulatorConfig(reader);
}

std::string refusalOf(const std::string& text) {
  try {
    read(kWorld + text);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

/// Position of a configuration's vehicle after 2 s of a command.
Pose2 driven(const std::string& text, const MotorPower& power) {
  RobotSettings settings = read(kWorld + text).settings.robot;
  settings.motion_noise = false;
  SimulatedRobot robot(std::make_shared<const World>(WorldDescription{}), settings);
  robot.setPower(power);
  robot.advanceTo(2'000'000);
  return robot.truth().T_map_body;
}

}  // namespace

TEST_CASE("the shipped simulators can be read, and drive the dynamic vehicle") {
  for (const char* name :
       {"demo.yaml", "meadow.yaml", "field.yaml", "field_weak_left_drive.yaml"}) {
    ConfigReader reader = ConfigReader::fromFile(kSimulators + name);
    CHECK_FALSE(readSimulatorConfig(reader).model);
  }
}

TEST_CASE("a simulator's model is a file beside its configuration, or none") {
  CHECK_FALSE(read(kWorld).model);
  CHECK_FALSE(read(kWorld + "model: none\n").model);
  const SimulatorConfig config = read(kWorld + "model: ../models/teodor_grass.yaml\n");
  REQUIRE(config.model);
  CHECK(config.model->vehicle.name == "teodor_grass");
  CHECK_FALSE(read(kWorld + "model: ../models/teodor_grass.yaml\n", {"model=none"}).model);
}

TEST_CASE("a model that the simulator cannot drive is refused in one line") {
  using Catch::Contains;
  CHECK_THAT(refusalOf("model: ../models/warthog_nominal.yaml\n"),
             Contains("test.yaml:4") && Contains("track speeds") && Contains("gives power"));
  CHECK_THAT(refusalOf("model: nowhere.yaml\n"), Contains("nowhere.yaml: cannot be read"));
  CHECK_THAT(refusalOf("model: ../models/teodor_grass.yaml\nvehicle: {mass: 300}\n"),
             Contains("test.yaml:5") && Contains("one of them"));
}

TEST_CASE("the dynamic vehicle's physical parameters are read strictly") {
  using Catch::Contains;
  const SimulatorConfig config =
      read(kWorld + "vehicle: {left_power: 0.9, capacity: 50, charge: 0.5, dead_power: 0.1}\n");
  CHECK(config.settings.robot.vehicle.left_power == 0.9);
  CHECK(config.settings.robot.vehicle.right_power == 1.0);
  CHECK(config.settings.robot.vehicle.drive.capacity == 50.0 * 3600.0);
  CHECK(read(kWorld).settings.robot.vehicle.drive.capacity == DriveParameters{}.capacity);
  CHECK_THAT(refusalOf("vehicle: {left_pover: 0.9}\n"), Contains("left_pover"));
  CHECK_THAT(refusalOf("vehicle:\n  left_power: 3\n"), Contains("test.yaml:5"));
  CHECK_THAT(refusalOf("vehicle:\n  empty_voltage: 30\n"),
             Contains("test.yaml:5") && Contains("full_voltage"));
}

TEST_CASE("what is changed in the dynamic vehicle shows in its motion") {
  const Pose2 usual = driven("", {0.8, 0.8});
  CHECK(std::abs(usual.yaw) < 1e-6);
  CHECK(driven("vehicle: {left_power: 0.9}\n", {0.8, 0.8}).yaw > 0.1);
  CHECK(driven("vehicle: {right_power: 0.9}\n", {0.8, 0.8}).yaw < -0.1);
  CHECK(driven("vehicle: {dead_power: 0.1}\n", {0.8, 0.8}).x < 0.92 * usual.x);
  CHECK(driven("vehicle: {dead_power: 0.1}\n", {0.09, 0.09}).x == 0.0);
  CHECK(driven("vehicle: {charge: 0.1}\n", {0.8, 0.8}).x < 0.95 * usual.x);
  const double turned = driven("", {-0.5, 0.5}).yaw;
  CHECK(driven("vehicle: {force_limit: 400}\n", {-0.5, 0.5}).yaw < 0.8 * turned);
}

TEST_CASE("a vehicle of 17 kg and its laser of any rate can be said, a track too light cannot") {
  const std::string folder = std::string(TREAD_SOURCE_DIR) + "/tests/data/robots/jackal";
  const RobotSettings jackal = readSimulatedRobot(folder);
  CHECK(jackal.vehicle.mass == 17.0);
  CHECK(jackal.laser.beams == 720);
  CHECK(jackal.laser.period_us == 25'000);
  CHECK(jackal.laser.sweep_us == 18'750);  // 270 of 360 degrees
  CHECK(readSimulatedRobot(std::string(TREAD_SOURCE_DIR) + "/config/robots/teodor").laser.beams ==
        LaserParameters().beams);
  CHECK(refusalOf("vehicle: {track_mass: 5}\n").find("a 50th of the mass, 8.00 kg") !=
        std::string::npos);
}

TEST_CASE("a light vehicle drives on every ground without shaking") {
  RobotSettings jackal =
      readSimulatedRobot(std::string(TREAD_SOURCE_DIR) + "/tests/data/robots/jackal");
  jackal.motion_noise = false;
  for (const SurfaceParameters& surface : builtInSurfaces()) {
    CAPTURE(surface.name);
    WorldDescription world;
    world.base_surface = surface.name;
    SimulatedRobot robot(std::make_shared<const World>(world), jackal);
    robot.setPower({0.5, 0.5});
    robot.advanceTo(3'000'000);
    const double before = robot.truth().v_body.v_x;
    CHECK(before > 0.8);
    CHECK(std::abs(robot.truth().v_body.omega) < 0.01);
    robot.advanceTo(3'001'000);
    CHECK(robot.truth().v_body.v_x == Approx(before).margin(0.002));
    robot.setPower({});
    robot.advanceTo(12'000'000);
    const Pose2 rest = robot.truth().T_map_body;
    robot.advanceTo(14'000'000);
    CHECK(distanceBetween(rest, robot.truth().T_map_body) < 0.002);
  }
}

}  // namespace tread::sim
