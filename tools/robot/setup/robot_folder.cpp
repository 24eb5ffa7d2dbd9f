// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/setup/robot_folder.hpp"

#include <algorithm>
#include <cmath>
#include <sstream>

#include "common/config/config_reader.hpp"
#include "common/config/scalars.hpp"
#include "common/geometry/degrees.hpp"
#include "common/report/text.hpp"
#include "modules/ins_driver/ins_driver_node.hpp"
#include "modules/motor_bridge/motor_bridge_node.hpp"

namespace tread::setup {
namespace {

/// Few digits, since people read them.
std::string rounded(double value, int decimals = 3) {
  const double unit = std::pow(10.0, -decimals);
  return formatNumber(std::round(value / unit) / std::pow(10.0, decimals));
}

/// Five decimals, so that pi stays within a turn.
std::string numbersOf(double a, double b, double c) {
  return "[" + rounded(a, 5) + ", " + rounded(b, 5) + ", " + rounded(c, 5) + "]";
}

std::string sizeText(const FootprintSize& size) {
  return "  front: " + rounded(size.front) + "\n  rear: " + rounded(size.rear) +
         "\n  half_width: " + rounded(size.half_width) + "\n";
}

std::string flag(bool value) {
  return value ? "true" : "false";
}

std::string insText(const RobotFindings& findings) {
  const Device& ins = findings.ins;
  return "# Found and measured by tread-setup-robot.\nsource: " + ins.kind +
         "\naddress: " + ins.address + "\nstore: state/ins_driver\n" + ins.section;
}

std::string motorText(const RobotFindings& findings) {
  const Device& controller = findings.controller;
  const commissioning::WiringReport& wiring = findings.wiring;
  const bool described = !findings.line_description.empty();
  // The weaker side gets larger commands, which the monitor sees as a pull to one side.
  const double stronger = std::max(wiring.full_left.value, wiring.full_right.value);
  const double pull = stronger > 0.0 ? 0.25 + 1.0 - wiring.fullSpeed() / stronger : 0.25;
  return "controller: " + controller.kind + "\naddress: " + controller.address + "\n" +
         (described ? "" : controller.section) +
         "motion_monitor:           # what the robot makes of its commands\n  delay: " +
         rounded(std::clamp(wiring.delay.high + 0.1, 0.25, 0.6), 2) +
         "             # s, longest time from a command to its first effect\n  lag: " +
         rounded(std::clamp(1.5 * wiring.lag.high + 0.1, 0.45, 1.0), 2) +
         "               # s, slowest time constant of the tracks\n  dead_band: " +
         rounded(std::clamp(wiring.dead_power.high + 0.1, 0.15, 0.4), 2) +
         "         # share of full_speed that need not move anything\n  pull: " +
         rounded(std::clamp(pull, 0.25, 0.5), 2) +
         "              # to one side, where nothing is wrong\n";
}

std::string lidarText(const RobotFindings& findings) {
  const Device& finder = findings.range_finder;
  return "device: " + finder.kind + "\naddress: " + finder.address +
         "\nrange_min: 0.1            # m\nrange_max: " + rounded(findings.range, 1) +
         "            # m\n" + finder.section;
}

}  // namespace

std::string indented(const std::string& text, size_t blanks) {
  std::string result, line;
  std::istringstream lines(text);
  while (std::getline(lines, line)) result += std::string(blanks, ' ') + line + "\n";
  return result;
}

std::string carSection(const RobotFindings& findings) {
  return "vesc:\n  throttle: [1]\n  steering: 1             # its servo output\n  servo_left: " +
         rounded(findings.servo_left) + "\n  servo_right: " + rounded(findings.servo_right) +
         "\n  watchdog: 0.2           # s\n";
}

std::string robotText(const RobotDescription& robot) {
  const auto& ins = robot.ins;
  const auto& finder = robot.range_finder;
  std::string text =
      "# The robot, described once; x forward, y left, z up. Made by tread-setup-robot.\nname: " +
      formatText(robot.name) + "\noutline:                    # m from the body origin\n" +
      sizeText(robot.outline) + "footprint:                  # m: what plans keep free\n" +
      sizeText(robot.footprint) + "height: " + rounded(robot.height) +
      "\ngauge: " + rounded(robot.gauge) +
      "                # m, as it turns on the ground\ndrive:\n" +
      (robot.drive.layout == DriveLayout::kSkidSteer4 ? "  layout: skid_steer_4\n" : "") +
      "  kind: " + nameOf(robot.drive.kind) + "\n  full_speed: " + rounded(robot.drive.full_speed) +
      "         # m/s at full command\n  max_command: " + rounded(robot.drive.max_command) +
      (robot.drive.isCar()
           ? "\n  layout: throttle_steering\n  wheelbase: " + rounded(robot.drive.wheelbase) +
                 "          # m\n  max_steering: " + rounded(robot.drive.max_steering) +
                 "       # rad"
           : "\n  left_channel: " + std::to_string(robot.drive.left_channel)) +
      "\n  invert_" + (robot.drive.isCar() ? "throttle" : "left") + ": " +
      flag(robot.drive.invert_left) + "\n  invert_" + (robot.drive.isCar() ? "steering" : "right") +
      ": " + flag(robot.drive.invert_right) +
      "\nins:\n  antenna: " + numbersOf(ins.p_body.x(), ins.p_body.y(), ins.p_body.z()) +
      "  # m in body\n  mounting: " + numbersOf(ins.angles.yaw, ins.angles.pitch, ins.angles.roll) +
      "  # rad: yaw, pitch and roll\nrange_finder:\n  position: " +
      numbersOf(finder.p_body.x(), finder.p_body.y(), finder.p_body.z()) +
      "\n  mounting: " + numbersOf(finder.angles.yaw, finder.angles.pitch, finder.angles.roll) +
      "\nlimits:\n  speed: " + rounded(robot.max_speed) +
      "                 # m/s: faster than it can ever be\n  stopping: " +
      rounded(robot.stopping_time, 2) + "            # s at its speed that it goes on after zero\n";
  if (robot.max_tilt) text += "  tilt: " + rounded(*robot.max_tilt) + "\n";
  if (robot.tilt)
    text += "  roll: " + rounded(toDegrees(robot.tilt->roll), 1) +
            "                  # deg\n  pitch: " + rounded(toDegrees(robot.tilt->pitch), 1) +
            "\n  roll_rate: " + rounded(toDegrees(robot.tilt->roll_rate), 1) +
            "\n  pitch_rate: " + rounded(toDegrees(robot.tilt->pitch_rate), 1) + "\n";
  if (robot.max_slope) text += "  slope: " + rounded(toDegrees(*robot.max_slope), 1) + "\n";
  return text + "operator:\n  lease: 1                  # s\n  lost: stop\n";
}

namespace {

void takeDrive(const DriveDescription& drive, Drivers& drivers) {
  drivers.full_command = drive.fullCommand();
  if (!drive.isCar()) return;
  drivers.full_steering = drive.max_steering;
  drivers.wheelbase = drive.wheelbase;
}

}  // namespace

Drivers driversOf(const RobotFindings& findings) {
  const std::string robot = "robot:\n" + indented(robotText(findings.robot), 2);
  Drivers drivers;
  if (!findings.ins.kind.empty()) {
    ConfigReader ins = ConfigReader::fromText(insText(findings) + robot, "ins_driver.yaml");
    drivers.make_ins = ins::readInsDriverConfig(ins).make_source;
    drivers.ins_address = findings.ins.address;
  }
  takeDrive(findings.robot.drive, drivers);
  if (findings.controller.kind.empty()) return drivers;
  ConfigReader motor = ConfigReader::fromText(
      "controller: " + findings.controller.kind + "\n" + findings.controller.section + robot,
      "motor_bridge.yaml");
  drivers.make_motor = motor::readMotorBridgeConfig(motor).make_controller;
  drivers.motor_address = findings.controller.address;
  return drivers;
}

Drivers driversOf(const std::string& folder) {
  ConfigReader ins = ConfigReader::fromFile(folder + "/ins_driver.yaml");
  ConfigReader motor = ConfigReader::fromFile(folder + "/motor_bridge.yaml");
  ConfigReader beside = ConfigReader::fromText("{}", folder + "/setup");
  const ins::InsDriverConfig ins_config = ins::readInsDriverConfig(ins);
  const motor::MotorBridgeConfig motor_config = motor::readMotorBridgeConfig(motor);
  Drivers drivers;
  drivers.ins_address = ins_config.address;
  drivers.make_ins = ins_config.make_source;
  drivers.motor_address = motor_config.address;
  drivers.make_motor = motor_config.make_controller;
  takeDrive(readRobot(beside).drive, drivers);
  return drivers;
}

void proposeLimits(RobotFindings& findings) {
  const commissioning::WiringReport& wiring = findings.wiring;
  RobotDescription& robot = findings.robot;
  robot.drive.full_speed = wiring.fullSpeed();
  if (robot.drive.isCar()) {
    robot.drive.max_steering = std::min(wiring.steering_left.value, -wiring.steering_right.value);
  } else {
    robot.gauge = wiring.gauge.value;
  }
  robot.max_speed = std::max(4.0, 3.0 * robot.drive.full_speed);
  robot.stopping_time = std::clamp(1.5 * (wiring.delay.high + wiring.lag.high), 0.3, 3.0);
  if (!findings.has_attitude) return;
  robot.max_tilt = 0.2;
  robot.tilt = TiltLimits{toRadians(30.0), toRadians(30.0), toRadians(60.0), toRadians(60.0)};
  robot.max_slope = toRadians(15.0);
}

ModelDocument modelOf(const RobotFindings& findings) {
  const commissioning::WiringReport& wiring = findings.wiring;
  const double left = wiring.full_left.value, right = wiring.full_right.value;
  ModelDocument document;
  VehicleModel& model = document.vehicle;
  model.name = findings.robot.name;
  model.kind = CommandKind::kPower;
  model.full_speed = 0.5 * (left + right) / (1.0 - wiring.dead_power.value);
  model.gauge = findings.robot.gauge;
  if (findings.robot.drive.isCar()) {
    model.wheelbase = findings.robot.drive.wheelbase;
    model.steering_lag = wiring.steering_lag.value;
  }
  model.lag = wiring.lag.value;
  model.delay = wiring.delay.value;
  model.effects.motor_deadband = wiring.dead_power.value * model.full_speed;
  model.effects.track_asymmetry = (left - right) / (left + right);
  // Typical spread between measured grounds; the recordings give better values.
  model.spread = {0.03, 0.06, 0.03};
  document.provenance.tool = "tread-setup-robot";
  return document;
}

std::map<std::string, std::string> folderOf(const RobotFindings& findings) {
  std::map<std::string, std::string> files{
      {"robot.yaml", robotText(findings.robot)},
      {"ins_driver.yaml", insText(findings)},
      {"motor_bridge.yaml", motorText(findings)},
      {"lidar_driver.yaml", lidarText(findings)},
      {"mapping.yaml",
       "cell_size: 0.1            # m\nmarking_range: " + rounded(findings.marking_range, 1) +
           "         # m: obstacles are marked to\n"},
      {"learner.yaml",
       "patterns: patterns.yaml   # as driven where it was set up\n"
       "robot: robot.yaml\nstore: state/learner\nrule: multi_model\n"},
      {"planner.yaml",
       "store: state/planner\nmargins:\n  regain: 0.15\nfield:\n"
       "  tight_weight: 20        # a gap that is just passable costs time\n"}};
  if (!findings.line_description.empty()) files["line_protocol.yaml"] = findings.line_description;
  return files;
}

}  // namespace tread::setup
