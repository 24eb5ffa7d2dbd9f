// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "tools/lab/missions/mission.hpp"

namespace tread::missions {

/// The world of a simulator configuration (config/simulators): its world, start and seed, with this
/// goal in the map. Throws ConfigError with file:line.
/** Nothing is drawn: line_blocked and surface_changes keep their defaults. */
MissionWorld readMissionWorld(const std::string& simulator_file, const Eigen::Vector2d& p_map_goal);

}  // namespace tread::missions
