// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/geometry/footprint_size.hpp"
#include "common/geometry/se2.hpp"
#include "common/grid/grid.hpp"
#include "modules/simulator/core/world.hpp"

namespace tread {
class plan_tree_t;
}

namespace tread::report {

/// One branch of a search tree, in map.
struct TreeEdge {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
  bool chosen = false;
};

/// Where the vehicle was at a time.
struct TrackPoint {
  double time = 0.0;  ///< [s] since the drive began
  Pose2 T_map_body;
};

/// How far a pattern ended from its prediction.
struct PatternError {
  double time = 0.0;      ///< [s] of its end
  double position = 0.0;  ///< [m]
  double yaw = 0.0;       ///< [rad]
};

/// The same executions, predicted by a rule of learning.
struct RuleSeries {
  std::string rule;
  std::vector<PatternError> errors;
};

/// A change of the true surface under the robot. Who turns round on a border crosses it again.
struct Crossing {
  double time = 0.0;  ///< [s] since the drive began
  std::string from;
  std::string to;
};

/// All that a picture of a drive shows. What is empty is left out.
struct DriveScene {
  std::string title;
  std::optional<sim::WorldDescription> world;  ///< true ground and obstacles, if they are known
  TileMap map{0.1, 32};  ///< what mapping published
  std::vector<TreeEdge> tree;
  std::vector<TrackPoint> track;
  std::optional<FootprintSize> outline;  ///< of the vehicle, drawn along the track
  Pose2 T_map_start;
  Pose2 T_map_goal;
  std::vector<Eigen::Vector2d> contacts;  ///< p_map [m]
  std::vector<PatternError> errors;       ///< as driven
  std::vector<RuleSeries> by_rule;        ///< drawn as running means
  std::vector<Crossing> crossings;
  double duration = 1.0;  ///< [s]
};

/// Draws ground, map, obstacles, track and tree beside the prediction error of each pattern.
/** Throws std::runtime_error with one clear line if the file cannot be written. */
void drawDrive(const std::string& path, const DriveScene& scene);

/// The branches of a tree as it is published.
std::vector<TreeEdge> edgesOf(const plan_tree_t& message);

}  // namespace tread::report
