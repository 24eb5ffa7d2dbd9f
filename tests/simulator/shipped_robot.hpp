// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "modules/simulator/simulator_files.hpp"

namespace tread::sim {

/// The simulated robot of config/robots/teodor.
inline RobotSettings shippedRobot() {
  static const RobotSettings settings =
      readSimulatedRobot(TREAD_SOURCE_DIR "/config/robots/teodor");
  return settings;
}
inline VehicleParameters shippedVehicle() {
  return shippedRobot().vehicle;
}

}  // namespace tread::sim
