// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <fstream>
#include <sstream>

#include "common/config/config_reader.hpp"
#include "common/vehicle/robot_description.hpp"

using namespace tread;
using Catch::Contains;

namespace {

const std::string kTeodor = TREAD_SOURCE_DIR "/config/robots/teodor/";
const std::string kSmall = TREAD_SOURCE_DIR "/tests/data/robots/small/";

RobotDescription robotOf(const std::string& process_text, const std::string& process_file) {
  ConfigReader reader = ConfigReader::fromText(process_text, process_file);
  RobotDescription robot = readRobot(reader);
  reader.finish();
  return robot;
}

std::string refusalOf(const std::string& process_text, const std::string& process_file) {
  try {
    robotOf(process_text, process_file);
  } catch (const ConfigError& error) {
    return error.what();
  }
  return "accepted";
}

/// The small robot's description as one map, with one line replaced.
std::string smallWith(const std::string& line, const std::string& other) {
  std::ostringstream text;
  text << "robot:\n";
  std::ifstream file(kSmall + "robot.yaml");
  for (std::string word; std::getline(file, word);)
    text << "  " << (word.rfind(line, 0) == 0 ? other : word) << "\n";
  return text.str();
}

}  // namespace

TEST_CASE("a process finds its robot beside its own file, by name, or in its own text") {
  const RobotDescription beside = robotOf("{}", kTeodor + "planner.yaml");
  CHECK(beside.name == "teodor");
  CHECK(beside.outline.length() == 1.3);
  CHECK(beside.footprint.half_width == 0.415);
  CHECK(beside.drive.fullCommand() == 1.0);
  CHECK(beside.range_finder.p_body.z() == 0.5);
  CHECK(robotOf("robot: ../../../tests/data/robots/small/robot.yaml", kTeodor + "x.yaml").name ==
        "small");
  const RobotDescription within = robotOf(smallWith("name:", "name: another"), "log");
  CHECK(within.name == "another");
  CHECK(within.ins.p_body.z() == 0.6);
  CHECK(within.ins.angles.yaw == 0.02);
  CHECK(within.drive.left_channel == 2);
  CHECK(robotOf("{}", kSmall + "x.yaml").drive.invert_left);
}

TEST_CASE("what a process says of its configuration holds the robot, and can be read again") {
  ConfigReader reader = ConfigReader::fromText("{}", kTeodor + "planner.yaml");
  readRobot(reader);
  const RobotDescription again = robotOf(reader.effective(), "CONFIG of a log");
  CHECK(again.name == "teodor");
  CHECK(again.footprint.front == 0.735);
}

TEST_CASE("what is missing or wrong in a robot is told with its key and file") {
  CHECK_THAT(
      refusalOf("{}", "/nowhere/planner.yaml"),
      Contains("/nowhere/planner.yaml: /nowhere/robot.yaml is needed") && Contains("robot:"));
  CHECK_THAT(refusalOf("robot: none.yaml", "/nowhere/planner.yaml"),
             Contains("/nowhere/none.yaml: cannot be read"));
  CHECK_THAT(refusalOf(smallWith("gauge:", ""), "p.yaml"),
             Contains("required key 'robot.gauge' is missing"));
  CHECK_THAT(refusalOf(smallWith("outline:", "outline: {front: 1, rear: 1}"), "p.yaml"),
             Contains("p.yaml:") && Contains("robot.outline.half_width"));
  CHECK_THAT(refusalOf(smallWith("footprint:",
                                 "footprint: {front: 0.5, rear: 0.3, "
                                 "half_width: 0.2}"),
                       "p.yaml"),
             Contains("not be smaller than the outline"));
  CHECK_THAT(refusalOf(smallWith("height:", "hight: 1"), "p.yaml"), Contains("height"));
  CHECK_THAT(refusalOf(smallWith("drive:", "drive: {kind: torque}"), "p.yaml"),
             Contains("power, track_speed"));
}

TEST_CASE("a car has throttle and steering with their ranges, and needs its wheelbase") {
  const std::string car = "drive: {layout: throttle_steering, kind: power, full_speed: 2, ";
  const RobotDescription robot =
      robotOf(smallWith("drive:", car + "max_command: 0.8, wheelbase: 1.1, max_steering: 0.4, "
                                        "invert_steering: true}"),
              "p.yaml");
  CHECK(robot.drive.isCar());
  CHECK(robot.drive.invert_right);
  const CommandChannels channels = robot.drive.channels();
  REQUIRE(channels.size() == 2);
  CHECK(channels[0].name == "throttle");
  CHECK(channels[0].highest == 0.8);
  CHECK(channels[1].name == "steering");
  CHECK(channels[1].kind == CommandKind::kSteeringAngle);
  CHECK(channels[1].lowest == -0.4);
  CHECK_THAT(refusalOf(smallWith("drive:", car + "max_command: 1, max_steering: 0.4}"), "p.yaml"),
             Contains("wheelbase"));
  CHECK_THAT(refusalOf(smallWith("drive:", car + "max_command: 1, wheelbase: 1, max_steering: 0.4, "
                                                 "left_channel: 2}"),
                       "p.yaml"),
             Contains("left_channel"));
  CHECK_THAT(refusalOf(smallWith("drive:", "drive: {layout: legs, kind: power}"), "p.yaml"),
             Contains("skid_steer_4"));
}

TEST_CASE("limits of tilt stand in degrees, and a robot without any is not watched") {
  const RobotDescription robot = robotOf("{}", kSmall + "x.yaml");
  REQUIRE(robot.tilt);
  CHECK(robot.tilt->roll == Approx(25 * kPi / 180));
  CHECK(robot.tilt->pitch == Approx(20 * kPi / 180));
  CHECK(robot.tilt->roll_rate == 1.0);
  CHECK(*robot.max_slope == Approx(12 * kPi / 180));
  const RobotDescription without = robotOf(smallWith("limits:", "limits: {speed: 8}"), "p.yaml");
  CHECK_FALSE(without.tilt);
  CHECK_FALSE(without.max_slope);
}

TEST_CASE("half a limit of tilt, one in radians, or one below the planner's slope is refused") {
  const auto refusal = [](const std::string& limits) {
    return refusalOf(smallWith("limits:", "limits: {speed: 8, " + limits + "}"), "p.yaml");
  };
  CHECK_THAT(refusal("roll: 25"), Contains("required key 'robot.limits.pitch' is missing"));
  CHECK_THAT(refusal("roll: 0.5, pitch: 0.5"), Contains("robot.limits.roll") && Contains("deg"));
  CHECK_THAT(refusal("roll: 25, pitch: 10, slope: 12"),
             Contains("slope") && Contains("must be below roll and pitch"));
}

TEST_CASE("fences stand in the robot's file, and one that is none is told with its fault") {
  const auto with = [](const std::string& corners) {
    return smallWith("limits:",
                     "limits: {speed: 8, stopping: 0.7}\n  fences:\n  - {name: yard, kind: "
                     "keep_out, corners: " +
                         corners + "}");
  };
  const RobotDescription robot = robotOf(with("[[0, 0], [4, 0], [4, 3]]"), "p.yaml");
  CHECK(robot.stopping_time == 0.7);
  REQUIRE(robot.fences.size() == 1);
  CHECK(robot.fences[0] == Fence{"yard", true, {{0, 0}, {4, 0}, {4, 3}}});
  CHECK_THAT(refusalOf(with("[[0, 0], [4, 0]]"), "p.yaml"),
             Contains("corners") && Contains("a fence needs 3 to 64 corners"));
  std::string more = with("[[0, 0], [4, 0], [4, 3]]");
  for (int i = 0; i < 32; ++i)
    more.insert(more.find("  - {name: yard"),
                "  - {name: pond, kind: keep_out, corners: [[0, 0], [4, 0], [4, 3]]}\n");
  CHECK_THAT(refusalOf(more, "p.yaml"), Contains("too many fences or corners"));
}
