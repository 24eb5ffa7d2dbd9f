// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/mapping/mapping_config.hpp"

#include <cstdio>

#include "common/vehicle/robot_file.hpp"

namespace tread::mapping {
namespace {

std::string metres(double length) {
  char text[32];
  std::snprintf(text, sizeof text, "%.2f", length);
  return text;
}

void readGrid(ConfigReader& reader, OccupancyMapConfig& map) {
  int64_t tile_cells = map.tile_cells;
  int64_t window_tiles = map.window_tiles;
  reader.number("cell_size", map.voxels.cell_size, {0.02, 0.5}, "m");
  reader.integer("tile_cells", tile_cells, {8, 128}, "cells");
  reader.integer("window_tiles", window_tiles, {2, 32}, "tiles");
  if (tile_cells % GroundModel::kPatchCells != 0)
    throw reader.error("tile_cells", "must be a multiple of 8");
  if (tile_cells * window_tiles > 1024)
    throw reader.error("window_tiles", "window_tiles x tile_cells must not be above 1024 cells");
  map.tile_cells = static_cast<int>(tile_cells);
  map.window_tiles = static_cast<int>(window_tiles);
}

void takeRobot(const ConfigReader& reader, const RobotDescription& robot, OccupancyMapConfig& map) {
  map.robot = robot.outline;
  map.obstacle.robot_height = robot.height;
  if (robot.height <= map.obstacle.step)
    throw reader.error("step",
                       "must be below the robot's height of " + metres(robot.height) + " m");
  const double highest = kVoxelsAboveGround * map.voxels.cell_size;
  if (robot.height > highest)
    throw reader.error("cell_size", "a robot of " + metres(robot.height) +
                                        " m needs larger cells: the map keeps " +
                                        std::to_string(kVoxelsAboveGround) +
                                        " of them above the ground, which is " + metres(highest) +
                                        " m");
}

void readMap(ConfigReader& reader, OccupancyMapConfig& map) {
  reader.number("marking_range", map.marking_range, {0.5, 100.0}, "m");
  reader.number("clearing_range", map.clearing_range, {0.5, 100.0}, "m");
  reader.number("start_free_radius", map.start_free_radius, {0.0, 5.0}, "m");
  reader.number("step", map.obstacle.step, {0.02, 1.0}, "m");
  ConfigReader evidence = reader.section("evidence");
  evidence.number("hit", map.voxels.hit, {0.51, 0.99}, "");
  evidence.number("miss", map.voxels.miss, {0.01, 0.49}, "");
  evidence.number("clamp_min", map.voxels.clamp_min, {0.01, 0.49}, "");
  evidence.number("clamp_max", map.voxels.clamp_max, {0.51, 0.99}, "");
  ConfigReader ground = reader.section("ground");
  ground.number("height_noise", map.ground.height_noise, {0.001, 1.0}, "m");
  ground.number("slope_noise", map.ground.slope_noise, {0.0, 1.0}, "");
  ground.number("curvature", map.ground.curvature, {0.0, 1.0}, "1/m");
  ground.number("slope_doubt", map.ground.slope_doubt, {0.0, 1.0}, "");
}

}  // namespace

MappingConfig readMappingConfig(ConfigReader& reader) {
  MappingConfig config;
  readGrid(reader, config.map);
  readMap(reader, config.map);
  const RobotDescription robot = readRobot(reader);
  takeRobot(reader, robot, config.map);
  config.top_speed = robot.max_speed;
  reader.number("publish_period", config.publish_period, {0.02, 2.0}, "s");
  reader.number("refresh_period", config.refresh_period, {0.2, 60.0}, "s");
  reader.number("max_ins_gap", config.max_ins_gap, {0.005, 2.0}, "s");
  reader.number("max_wait", config.max_wait, {0.02, 5.0}, "s");
  reader.number("silence", config.silence, {0.1, 60.0}, "s");
  reader.finish();
  config.effective = reader.effective();
  return config;
}

}  // namespace tread::mapping
