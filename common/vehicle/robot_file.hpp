// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/config/config_reader.hpp"
#include "common/vehicle/robot_description.hpp"

namespace tread {

/// The robot of a process: what its key `robot` holds or the file that it names, else robot.yaml
/// beside the process's own file.
/** Strict; throws ConfigError with file:line. reader.effective() then holds the description, too,
 * so that a logged CONFIG can be read without the file. */
RobotDescription readRobot(ConfigReader& reader);

/// Three keys that are all required: front, rear and half_width [m].
FootprintSize readFootprint(ConfigReader reader);

}  // namespace tread
