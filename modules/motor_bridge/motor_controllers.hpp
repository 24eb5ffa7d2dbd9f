// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <memory>
#include <string>

#include "common/config/config_reader.hpp"
#include "common/vehicle/robot_description.hpp"
#include "modules/motor_bridge/core/motor_controller.hpp"

namespace tread::motor {

using MakeMotorController = std::function<std::unique_ptr<MotorController>()>;

/// Reads the kind of the robot's controller (key `controller`, into `name`) and the section of that
/// name.
MakeMotorController readMotorController(ConfigReader& reader, const DriveDescription& drive,
                                        std::string& name);

}  // namespace tread::motor
