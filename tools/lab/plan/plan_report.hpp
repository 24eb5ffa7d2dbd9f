// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/grid/grid.hpp"
#include "modules/planner/core/search/path_planner.hpp"
#include "tools/lab/plan/plan_files.hpp"
#include "tools/lab/plan/query_file.hpp"

namespace tread::plan {

/// The closest approach to the goal.
struct ClosestApproach {
  Eigen::Vector2d p_map{0.0, 0.0};
  double distance = 0.0;  ///< [m] to the goal
};

/// The answer to one query. Poses are in the map's frame.
struct PlanAnswer {
  planner::PathEnd end = planner::PathEnd::kNoneInTime;
  bool all_seen = false;  ///< the search is complete: more time would not improve the result
  std::string reason;     ///< in words; empty if solved
  double cost = 0.0;      ///< of the plan, as counted by the planner
  double time = 0.0;      ///< [s] duration of the plan
  double length = 0.0;    ///< [m]
  std::vector<std::string> patterns;  ///< names, or ids if they have none
  /// T_map_body along the plan, start first, yaw -pi..pi; of the best partial plan if unsolved
  std::vector<Pose2> poses;
  std::vector<size_t> ends;  ///< index into poses of each pattern's end
  std::optional<ClosestApproach> closest;
  int64_t expansions = 0;
  std::optional<double> first_solution_ms;  ///< from the query to the first complete plan
  double total_ms = 0.0;      ///< from the query to the end, including all work for it
  double clearance_ms = 0.0;  ///< share of total_ms for preparation common to all queries of a map
  double heuristic_ms = 0.0;  ///< share of total_ms for the heuristics
  double memory_mb = 0.0;     ///< peak memory of the program so far
};

/// Adds the preparation time that all queries on a map share.
void addPreparation(PlanAnswer& answer, double preparation_ms);

/// JSON of one answer; unknown values are null.
nlohmann::ordered_json answerJson(const PlanAnswer& answer);

/// JSON of many answers: totals, and a short line for each.
/** Quantiles are nearest-rank; first_ms and length_m cover only solved queries, null if there are
 * none. expansions_per_s excludes the time for the heuristics. preparation_ms is spent once before
 * the first query and is in no other number. */
nlohmann::ordered_json answersJson(const std::vector<PlanQuery>& queries,
                                   const std::vector<PlanAnswer>& answers, double preparation_ms);

/// Writes JSON atomically; throws std::runtime_error with one clear line.
void writeJson(const std::string& path, const nlohmann::ordered_json& json);

/// Text of one answer, with line ends.
std::string answerText(const PlanAnswer& answer);

/// Text of many answers.
std::string answersText(const std::vector<PlanAnswer>& answers, double preparation_ms);

/// Result of a query in one line, without line end.
std::string headline(const PlanAnswer& answer);

/// The smallest value that at least a share 0..1 of the values does not exceed; NaN if empty.
double nearestRank(std::vector<double> values, double share);

/// Content of a plan's picture, in the map's frame except for the grid.
struct PlanScene {
  std::string title;
  std::string result;  ///< line below the title
  Grid grid;
  Pose2 T_map_grid;
  std::vector<std::vector<Eigen::Vector2d>> tree;  ///< points on each branch of the search tree
  std::vector<Eigen::Vector2d> path;               ///< points on the plan
  std::vector<Pose2> stations;                     ///< poses with a drawn footprint
  std::vector<Eigen::Vector2d> outline;            ///< p_body corners; empty = a disc
  double radius = 0.0;                             ///< [m] of that disc
  Pose2 T_map_start;
  Pose2 T_map_goal;
};

/// Corners of a rectangle centred at the body's origin.
std::vector<Eigen::Vector2d> rectangle(double length, double width);

/// Draws map, search tree, plan with footprints, start and goal, like the paper's Figure 2.
/** Throws std::runtime_error with one clear line if the file cannot be written. */
void drawPlan(const std::string& path, const PlanScene& scene);

}  // namespace tread::plan
