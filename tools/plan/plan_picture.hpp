// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/grid/grid.hpp"

namespace tread::plan {

/// All that a picture of a plan shows, in the map's own frame but for the grid.
struct PlanScene {
  std::string title;
  std::string result;  ///< a line below the title
  Grid grid;
  Pose2 T_map_grid;
  std::vector<std::vector<Eigen::Vector2d>> tree;  ///< points along each branch of the search
  std::vector<Eigen::Vector2d> path;               ///< points along the plan
  std::vector<Pose2> stations;                     ///< poses at which the footprint is drawn
  std::vector<Eigen::Vector2d> outline;            ///< p_body corners; empty = a disc
  double radius = 0.0;                             ///< [m] of that disc
  Pose2 T_map_start;
  Pose2 T_map_goal;
};

/// Corners of a rectangle about the body's origin.
std::vector<Eigen::Vector2d> rectangle(double length, double width);

/// Draws map, search tree, plan with footprints, start and goal, like the paper's Figure 2.
/** Throws std::runtime_error with one clear line if the file cannot be written. */
void drawPlan(const std::string& path, const PlanScene& scene);

}  // namespace tread::plan
