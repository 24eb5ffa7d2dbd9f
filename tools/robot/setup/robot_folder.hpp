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
#include "modules/commissioning/core/wiring_check.hpp"
#include "modules/ins_driver/core/ins_source.hpp"
#include "modules/motor_bridge/core/motor_controller.hpp"

namespace tread::setup {

/// A device behind a port.
struct Device {
  std::string kind;     ///< name in the driver's configuration; empty = none
  std::string address;  ///< including the baud rate of a serial line
  std::string section;  ///< additional YAML lines of this kind
  double rate = 0.0;    ///< [Hz] of its measurements
};

/// Share of beams with a result below which the planner knows too little to drive.
inline constexpr double kLeastTelling = 0.3;

/// Everything known of a robot so far.
struct RobotFindings {
  RobotDescription robot;
  Device ins, controller, range_finder;
  bool has_attitude = false;                     ///< the INS measures roll and pitch
  double watchdog = 0.2;                         ///< [s] of the controller
  double servo_left = 0.85, servo_right = 0.15;  ///< servo ends, for a car with VESCs
  std::string line_description;                  ///< its line protocol; empty = none
  commissioning::WiringReport wiring;
  double range = 0.0;            ///< [m] of the range finder
  double beams_that_tell = 1.0;  ///< [1] share of its beams with a hit or a reliable "no hit"
  double marking_range = 10.0;   ///< [m]
};

/// YAML lines for a car's VESC.
std::string carSection(const RobotFindings& findings);
/// robot.yaml.
std::string robotText(const RobotDescription& robot);
/// Text indented by so many blanks.
std::string indented(const std::string& text, size_t blanks);

/// Configuration of a robot's INS and motors.
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

/// The same as its folder will contain.
Drivers driversOf(const RobotFindings& findings);
/// Read from a robot's folder; throws ConfigError.
Drivers driversOf(const std::string& folder);

/// Derives speeds, stopping time and limits from the measurements.
void proposeLimits(RobotFindings& findings);

/// The measured two-track model.
ModelDocument modelOf(const RobotFindings& findings);

/// Files of a robot's folder by name, except patterns and model.
std::map<std::string, std::string> folderOf(const RobotFindings& findings);

}  // namespace tread::setup
