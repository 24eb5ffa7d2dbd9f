// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "common/config/config_reader.hpp"
#include "common/vehicle/robot_description.hpp"
#include "modules/motor_bridge/core/bridge.hpp"
#include "modules/motor_bridge/core/motor_controller.hpp"

namespace tread::motor {

using MakeMotorController = std::function<std::unique_ptr<MotorController>()>;

/// Reads which controller the robot has (key `controller`) and the section of that name.
MakeMotorController readMotorController(ConfigReader& reader, const DriveDescription& drive);

/// Configuration of motor_bridge, with its defaults.
struct MotorBridgeConfig {
  std::string address = "tty:/dev/ttyACM0?baud=115200";  ///< of the controller
  BridgeConfig bridge;
  MakeMotorController make_controller;  ///< of the kind that the configuration names
  std::string effective;                ///< the whole as YAML, for CONFIG
};

/// Reads the configuration; throws ConfigError with file:line.
/** No value switches a safeguard off: the lease, the INS limit and the controller's watchdog can
    only be made stricter than their defaults, or slightly longer where the hardware needs it. */
MotorBridgeConfig readMotorBridgeConfig(ConfigReader& reader);

}  // namespace tread::motor
