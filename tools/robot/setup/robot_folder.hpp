// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "common/vehicle/model_document.hpp"
#include "common/vehicle/robot_description.hpp"
#include "modules/ins_driver/core/ins_source.hpp"
#include "modules/motor_bridge/core/motor_controller.hpp"
#include "tools/robot/setup/core/wiring_check.hpp"

namespace tread::setup {

/// A device behind a port.
struct Device {
  std::string kind;     ///< as the driver's configuration names it; empty = none
  std::string address;  ///< with the rate of a serial line
  std::string section;  ///< lines of YAML that its kind needs
  double rate = 0.0;    ///< [Hz] of its measurements
};

/// Share of the beams that must tell something: elsewhere the planner knows too little to drive.
inline constexpr double kLeastTelling = 0.3;

/// All that is known of a robot so far.
struct RobotFindings {
  RobotDescription robot;
  Device ins, controller, range_finder;
  bool has_attitude = false;                     ///< the INS measures roll and pitch
  double watchdog = 0.2;                         ///< [s] of the controller
  double servo_left = 0.85, servo_right = 0.15;  ///< of a car with VESCs: its servo's ends
  std::string line_description;  ///< text of the controller's line protocol; empty = none
  WiringReport wiring;
  double range = 0.0;            ///< [m] of the range finder
  double beams_that_tell = 1.0;  ///< [1] share of its beams that hit, or know that nothing is there
  double marking_range = 10.0;   ///< [m]
};

/// Lines of YAML of a car's VESC.
std::string carSection(const RobotFindings& findings);
/// robot.yaml.
std::string robotText(const RobotDescription& robot);
/// Text with each line indented by so many blanks.
std::string indented(const std::string& text, size_t blanks);

/// What drives a robot's INS and motors.
struct Drivers {
  std::string ins_address;
  ins::MakeInsSource make_ins;
  std::string motor_address;
  std::function<std::unique_ptr<motor::MotorController>()> make_motor;
  double full_command = 1.0;
  double full_steering = 0.0;  ///< [rad] of a car
  double wheelbase = 0.0;      ///< [m] of a car; 0 = two sides

  bool isCar() const { return wheelbase > 0.0; }
};

/// Exactly as its folder will say.
Drivers driversOf(const RobotFindings& findings);
/// As a robot's folder says; throws ConfigError.
Drivers driversOf(const std::string& folder);

/// Speeds, stopping time and limits from what was measured.
void proposeLimits(RobotFindings& findings);

/// The two-track model that was measured.
ModelDocument modelOf(const RobotFindings& findings);

/// The files of a robot's folder by name, without patterns and model.
std::map<std::string, std::string> folderOf(const RobotFindings& findings);

}  // namespace tread::setup
