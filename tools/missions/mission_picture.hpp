// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "common/grid/grid.hpp"
#include "common/report/drive_picture.hpp"
#include "tools/missions/mission.hpp"
#include "tools/missions/mission_world.hpp"

namespace tread::missions {

/// What a picture of a mission shows beside its result.
struct MissionScene {
  MissionWorld world;
  TileMap map{0.1, 32};                ///< what mapping published
  std::vector<report::TreeEdge> tree;  ///< of a plan on the way
};

/// World, map, surfaces, true track, a tree and the prediction errors, to be drawn.
report::DriveScene driveSceneOf(const MissionResult& result, const MissionScene& scene);

}  // namespace tread::missions
