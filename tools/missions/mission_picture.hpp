// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "common/grid/grid.hpp"
#include "tools/missions/mission.hpp"
#include "tools/missions/mission_world.hpp"

namespace tread::missions {

/// One branch of the planner's last search tree, in map.
struct TreeEdge {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
  bool chosen = false;
};

/// What a picture of a mission shows beside its result.
struct MissionScene {
  MissionWorld world;
  TileMap map{0.1, 32};        ///< what mapping published
  std::vector<TreeEdge> tree;  ///< of a plan on the way
};

/// Draws world, map, surfaces, true track, last tree, and the prediction error of each execution.
/** Throws std::runtime_error with one clear line if the file cannot be written. */
void drawMission(const std::string& path, const MissionResult& result, const MissionScene& scene);

}  // namespace tread::missions
