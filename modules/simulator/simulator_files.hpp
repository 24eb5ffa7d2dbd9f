// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "common/config/config_reader.hpp"
#include "modules/simulator/core/robot.hpp"
#include "modules/simulator/core/world.hpp"

namespace tread::sim {

/// Reads a world file (config/worlds); throws ConfigError with file:line.
WorldDescription readWorld(const std::string& path);
/// The same from text; `name` stands for the file in messages.
WorldDescription parseWorld(const std::string& text, const std::string& name);

/// Reads a dynamic vehicle in physical quantities. The ranges keep the integration stable at 1 ms.
/** What is not named stays as it is; with `whole`, what is of this machine alone must be named. So
 * a drive that has lost power or a weak battery is hidden behind the serial lines. */
void readVehicle(ConfigReader reader, VehicleParameters& vehicle, bool whole = false);

/// The simulated robot of a configuration: keys `robot` and `dynamics`, each a file or a map.
/** Outline, mountings and, unless dynamics.yaml says otherwise, gauge and free speed are the
 * described robot's (robot.yaml), the rest of the vehicle stands in dynamics.yaml; both beside the
 * configuration if they are not named. */
void readSimulatedRobot(ConfigReader& reader, RobotSettings& settings);

/// The same from a robot's folder.
RobotSettings readSimulatedRobot(const std::string& folder);

}  // namespace tread::sim
