// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>

#include "common/config/config_reader.hpp"
#include "common/vehicle/model_document.hpp"
#include "modules/simulator/emulators/simulated_devices.hpp"

namespace tread::sim {

/// Configuration of the simulator process (config/simulators).
struct SimulatorConfig {
  std::string world;                   ///< path of a world file
  SimulatorSettings settings;          ///< start_utime and utc_at_zero are the process's to set
  std::optional<ModelDocument> model;  ///< drives in the place of the dynamic vehicle
  std::string ins = "pty:devices/ins";
  std::string motor = "pty:devices/motor";
  std::string laser = "tcp-server:127.0.0.1:10940";
  std::string record = "none";  ///< path of the truth as CSV, or none
};

/// Reads it strictly, the model file, too; throws ConfigError with file:line.
SimulatorConfig readSimulatorConfig(ConfigReader& reader);

}  // namespace tread::sim
