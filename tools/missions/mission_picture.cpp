// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/missions/mission_picture.hpp"

#include "common/report/text.hpp"

namespace tread::missions {
namespace {

std::string titleOf(const MissionResult& result) {
  return formatted(
      "Mission %llu: %s after %.0f s and %.1f m (straight line %.1f m), %d patterns, %d "
      "collisions%s%s",
      static_cast<unsigned long long>(result.seed), nameOf(result.outcome), result.time,
      result.distance, result.straight_line, result.completed, result.collisions,
      result.reason.empty() ? "" : ": ", result.reason.c_str());
}

}  // namespace

report::DriveScene driveSceneOf(const MissionResult& result, const MissionScene& scene) {
  report::DriveScene drive;
  const sim::WorldDescription& world = scene.world.description;
  drive.title = titleOf(result);
  drive.base_surface = world.base_surface;
  for (const sim::SurfaceRegion& region : world.regions)
    drive.patches.push_back({region.surface, region.corners});
  for (const sim::Obstacle& obstacle : world.obstacles)
    drive.obstacles.push_back({obstacle.corners, obstacle.centre, obstacle.radius});
  drive.map = scene.map;
  drive.tree = scene.tree;
  for (const TrackPoint& point : result.track)
    drive.track.push_back({point.time, point.T_map_body});
  drive.T_map_start = scene.world.T_map_start;
  drive.T_map_goal = scene.world.T_map_goal;
  for (const Contact& contact : result.contacts)
    drive.contacts.push_back(contact.T_map_body.position());
  for (const ScoredExecution& execution : result.executions)
    if (execution.measured)
      drive.errors.push_back({execution.time, execution.error_position, execution.error_yaw});
  for (const Crossing& crossing : result.crossings)
    drive.crossings.push_back({crossing.time, crossing.to});
  drive.duration = result.time;
  return drive;
}

}  // namespace tread::missions
