// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "tools/lab/missions/robot_system.hpp"

namespace tread::missions {

/// The robot of config/robots/teodor.
inline const RobotConfig& teodor() {
  static const RobotConfig robot =
      readRobot(std::string(TREAD_SOURCE_DIR) + "/config/robots/teodor");
  return robot;
}

}  // namespace tread::missions
