// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/vehicle/robot_description.hpp"

#include <algorithm>

#include "common/config/config_reader.hpp"
#include "common/fence/fence_book.hpp"
#include "common/geometry/degrees.hpp"
#include "common/vehicle/omni_wheels_file.hpp"

namespace tread {
namespace {

/// The keys of wheels exclude those of two tracks, and vice versa.
void readWheels(ConfigReader& reader, DriveDescription& drive) {
  for (const char* key : {"left_channel", "invert_left", "invert_right"})
    if (reader.has(key))
      throw reader.error(key, "is of two tracks; layout omni has wheels: {invert: true} in one");
  drive.wheels = readOmniWheels(reader, &drive.invert_wheels);
}

/// Wheelbase and steering of a car.
void readSteering(ConfigReader& reader, DriveDescription& drive) {
  reader.number("wheelbase", drive.wheelbase, {0.2, 10.0}, "m", true);
  reader.number("max_steering", drive.max_steering,
                {0.05, commandLimit(CommandKind::kSteeringAngle)}, "rad", true);
  reader.flag("invert_throttle", drive.invert_left);
  reader.flag("invert_steering", drive.invert_right);
}

DriveDescription readDrive(ConfigReader reader) {
  DriveDescription drive;
  std::string layout = "tracks";
  reader.choice("layout", layout, {"tracks", "skid_steer_4", "throttle_steering", "omni"});
  if (layout == "skid_steer_4") drive.layout = DriveLayout::kSkidSteer4;
  if (layout == "throttle_steering") drive.layout = DriveLayout::kThrottleSteering;
  if (layout == "omni") drive.layout = DriveLayout::kOmni;
  std::string kind;
  reader.choice("kind", kind, {"power", "track_speed"}, true);
  drive.kind = kind == "power" ? CommandKind::kPower : CommandKind::kTrackSpeed;
  reader.number("full_speed", drive.full_speed, {0.05, 20.0}, "m/s", true);
  reader.number("max_command", drive.max_command, {0.0, drive.fullCommand()},
                kind == "power" ? "1" : "m/s", true);
  if (drive.isCar()) {
    readSteering(reader, drive);
    return drive;
  }
  if (drive.isOmni()) {
    readWheels(reader, drive);
    return drive;
  }
  int64_t left_channel = drive.left_channel;
  reader.integer("left_channel", left_channel, {1, 2}, "1");
  drive.left_channel = static_cast<int>(left_channel);
  reader.flag("invert_left", drive.invert_left);
  reader.flag("invert_right", drive.invert_right);
  return drive;
}

Mounting readMounting(ConfigReader reader, const std::string& position_key) {
  std::vector<double> position;
  std::vector<double> angles(3, 0.0);
  reader.numbers(position_key, position, 3, {-20.0, 20.0}, "m", true);
  reader.numbers("mounting", angles, 3, {-kPi, kPi}, "rad");
  return {{position[0], position[1], position[2]}, {angles[0], angles[1], angles[2]}};
}

std::vector<Fence> readFences(ConfigReader& robot) {
  std::vector<Fence> fences;
  for (ConfigReader& reader : robot.sections("fences")) {
    Fence& fence = fences.emplace_back();
    std::string kind;
    std::vector<std::vector<double>> corners;
    reader.text("name", fence.name, true);
    reader.choice("kind", kind, {"stay_in", "keep_out"}, true);
    reader.table("corners", corners, 2, {-Fence::kFarthest, Fence::kFarthest}, "m", true);
    fence.keep_out = kind == "keep_out";
    for (const auto& corner : corners) fence.corners.emplace_back(corner[0], corner[1]);
    const std::string fault = faultOf(fence);
    if (!fault.empty()) throw reader.error("corners", fault);
    if (!FenceBook::fit(fences)) throw reader.error("corners", "too many fences or corners");
  }
  return fences;
}

/// The lease cannot be disabled.
OperatorRules readOperators(ConfigReader reader) {
  OperatorRules rules;
  std::string lost = "stop";
  reader.seconds("lease", rules.lease_us, {0.5, 5.0});
  reader.choice("lost", lost, {"stop", "finish", "go_back"});
  reader.seconds("return", rules.return_us, {5.0, 3600.0});
  reader.seconds("wait", rules.wait_us, {1.0, 600.0});
  if (lost == "finish") rules.lost = OperatorLost::kFinish;
  if (lost == "go_back") rules.lost = OperatorLost::kGoBack;
  return rules;
}

/// Users give slopes in degrees.
void readDegrees(ConfigReader& reader, const std::string& key, double& angle, Range range,
                 const std::string& unit, bool required) {
  double degrees = toDegrees(angle);
  reader.number(key, degrees, range, unit, required);
  angle = toRadians(degrees);
}

void readTilt(ConfigReader& limits, RobotDescription& robot) {
  if (limits.has("roll") || limits.has("pitch")) {
    TiltLimits& tilt = robot.tilt.emplace();
    readDegrees(limits, "roll", tilt.roll, {5.0, 60.0}, "deg", true);
    readDegrees(limits, "pitch", tilt.pitch, {5.0, 60.0}, "deg", true);
    readDegrees(limits, "roll_rate", tilt.roll_rate, {10.0, 180.0}, "deg/s", false);
    readDegrees(limits, "pitch_rate", tilt.pitch_rate, {10.0, 180.0}, "deg/s", false);
  }
  if (!limits.has("slope")) return;
  readDegrees(limits, "slope", robot.max_slope.emplace(), {2.0, 45.0}, "deg", false);
  if (robot.tilt && *robot.max_slope >= std::min(robot.tilt->roll, robot.tilt->pitch))
    throw limits.error("slope", "must be below roll and pitch, at which the robot is stopped");
}

RobotDescription readDescription(ConfigReader& reader) {
  RobotDescription robot;
  reader.text("name", robot.name, true);
  robot.outline = readFootprint(reader.section("outline", true));
  robot.footprint = readFootprint(reader.section("footprint", true));
  if (robot.footprint.front < robot.outline.front || robot.footprint.rear < robot.outline.rear ||
      robot.footprint.half_width < robot.outline.half_width)
    throw reader.error("footprint", "must not be smaller than the outline");
  reader.number("height", robot.height, {0.1, 5.0}, "m", true);
  robot.drive = readDrive(reader.section("drive", true));
  if (!robot.drive.isOmni()) {
    reader.number("gauge", robot.gauge, {0.05, 10.0}, "m", true);
  } else if (reader.has("gauge")) {
    throw reader.error("gauge", "is of two tracks; of layout omni the wheels' places say it");
  } else {
    robot.gauge = 2.0 * robot.drive.wheels.radius();
  }
  robot.ins = readMounting(reader.section("ins", true), "antenna");
  robot.range_finder = readMounting(reader.section("range_finder", true), "position");
  if (reader.has("ground_finder"))
    robot.ground_finder = readMounting(reader.section("ground_finder"), "position");
  ConfigReader limits = reader.section("limits", true);
  limits.number("speed", robot.max_speed, {0.5, 50.0}, "m/s", true);
  double tilt = std::numeric_limits<double>::quiet_NaN();
  limits.number("tilt", tilt, {0.0, 1.6}, "rad");
  if (std::isfinite(tilt)) robot.max_tilt = tilt;
  readTilt(limits, robot);
  limits.number("stopping", robot.stopping_time, {0.1, 3.0}, "s");
  robot.fences = readFences(reader);
  robot.operators = readOperators(reader.section("operator"));
  return robot;
}

}  // namespace

FootprintSize readFootprint(ConfigReader reader) {
  FootprintSize size;
  reader.number("front", size.front, {0.05, 10.0}, "m", true);
  reader.number("rear", size.rear, {0.05, 10.0}, "m", true);
  reader.number("half_width", size.half_width, {0.05, 5.0}, "m", true);
  return size;
}

CommandChannels DriveDescription::channels() const {
  CommandChannels channels = isCar()    ? carChannels(kind)
                             : isOmni() ? omniChannels(kind, wheels.size())
                                        : trackChannels(kind);
  for (CommandChannel& channel : channels) {
    channel.highest = channel.kind == CommandKind::kSteeringAngle ? max_steering : max_command;
    channel.lowest = -channel.highest;
  }
  return channels;
}

RobotDescription readRobot(ConfigReader& reader) {
  ConfigReader robot = reader.file("robot", "robot.yaml");
  return readDescription(robot);
}

bool describesOperators(ConfigReader& reader) {
  return !reader.has("robot") || reader.section("robot").has("operator");
}

}  // namespace tread
