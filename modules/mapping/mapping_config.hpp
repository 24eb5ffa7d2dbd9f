// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "common/config/config_reader.hpp"
#include "modules/mapping/core/occupancy_map.hpp"

namespace tread::mapping {

/// Configuration of mapping, with its defaults.
struct MappingConfig {
  OccupancyMapConfig map;
  double publish_period = 0.2;  ///< [s] between cycles of MAP; changed tiles wait no longer
  double refresh_period = 2.0;  ///< [s] in which every tile is sent at least once
  double max_ins_gap = 0.1;     ///< [s] between two poses that a beam's pose may lie between
  double max_wait = 0.5;        ///< [s] that a scan waits for INS
  double top_speed = 10.0;  ///< [m/s] of the robot; faster is a jump of the INS: a new map begins
  double silence = 1.0;     ///< [s] without a scan taken after which mapping is not well
  std::string effective;    ///< the whole as YAML, for CONFIG
};

/// Reads the configuration; throws ConfigError with file:line.
MappingConfig readMappingConfig(ConfigReader& reader);

}  // namespace tread::mapping
