// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/geometry/footprint_size.hpp"
#include "common/geometry/se2.hpp"
#include "common/grid/grid.hpp"

namespace tread {
class plan_tree_t;
}

namespace tread::report {

/// A patch of ground; later ones lie on top.
struct GroundPatch {
  std::string surface;
  std::vector<Eigen::Vector2d> corners;  ///< p_map [m]
};

/// A true obstacle: a polygon, or a disc where it has no corners.
struct ObstacleShape {
  std::vector<Eigen::Vector2d> corners;  ///< p_map [m]
  Eigen::Vector2d centre{0.0, 0.0};
  double radius = 0.0;  ///< [m]
};

/// One branch of a search tree, in map.
struct TreeEdge {
  Eigen::Vector2d from;
  Eigen::Vector2d to;
  bool chosen = false;
};

/// Where the vehicle was at a time [s].
struct DriveMoment {
  double time = 0.0;
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

/// The ground became another.
struct BorderCrossing {
  double time = 0.0;  ///< [s]
  std::string to;
};

/// All that a picture of a drive shows. What is empty is left out.
struct DriveScene {
  std::string title;
  std::string base_surface;  ///< where no patch lies; empty = unknown
  std::vector<GroundPatch> patches;
  std::vector<ObstacleShape> obstacles;
  TileMap map{0.1, 32};  ///< what mapping published
  std::vector<TreeEdge> tree;
  std::vector<DriveMoment> track;
  std::optional<FootprintSize> outline;  ///< of the vehicle, drawn along the track
  Pose2 T_map_start;
  Pose2 T_map_goal;
  std::vector<Eigen::Vector2d> contacts;  ///< p_map [m]
  std::vector<PatternError> errors;       ///< as driven
  std::vector<RuleSeries> by_rule;        ///< drawn as running means
  std::vector<BorderCrossing> crossings;
  double duration = 1.0;  ///< [s]
};

/// Draws ground, map, obstacles, track and tree beside the prediction error of each pattern.
/** Throws std::runtime_error with one clear line if the file cannot be written. */
void drawDrive(const std::string& path, const DriveScene& scene);

/// The branches of a tree as it is published.
std::vector<TreeEdge> edgesOf(const plan_tree_t& message);

}  // namespace tread::report
