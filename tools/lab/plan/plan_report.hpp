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

namespace tread::plan {

/// How near to the goal something could come.
struct ClosestApproach {
  Eigen::Vector2d p_map{0.0, 0.0};
  double distance = 0.0;  ///< [m] to the goal
};

/// All that is told about the answer to one query. Poses are in the map's own frame.
struct PlanAnswer {
  planner::PathEnd end = planner::PathEnd::kNoneInTime;
  bool all_seen = false;              ///< no more time would help: there is nothing better
  std::string reason;                 ///< in words; empty if it is solved
  double cost = 0.0;                  ///< of the plan, as the planner counts it
  double time = 0.0;                  ///< [s] to drive it
  double length = 0.0;                ///< [m]
  std::vector<std::string> patterns;  ///< names, or ids where they have none
  std::vector<Pose2> poses;           ///< T_map_body all along, start first, yaw -pi..pi; the best
                                      ///< so far if it is not solved
  std::vector<size_t> ends;           ///< for each pattern, which of the poses is its end
  std::optional<ClosestApproach> closest;
  int64_t expansions = 0;
  std::optional<double> first_solution_ms;  ///< from the query to the first plan to the goal
  double total_ms = 0.0;                    ///< from the query to the end, all work for it included
  double clearance_ms = 0.0;                ///< of that for what all queries on a map share
  double heuristic_ms = 0.0;                ///< of that for the heuristics
  double memory_mb = 0.0;                   ///< the most that the program has needed so far
};

/// Counts what all queries on a map share for this one.
void addPreparation(PlanAnswer& answer, double preparation_ms);

/// The answer to one query: what could not be found out is null.
nlohmann::ordered_json answerJson(const PlanAnswer& answer);

/// What the answers to many queries have in common, and a short line about each.
/** Quantiles are of nearest rank; first_ms and length_m are of the solved ones only, and null if
 * there is none. expansions_per_s counts the time without that for the heuristics. preparation_ms
 * was spent once, before the first query, and is not in the others. */
nlohmann::ordered_json answersJson(const std::vector<PlanQuery>& queries,
                                   const std::vector<PlanAnswer>& answers, double preparation_ms);

/// Writes JSON whole or not at all; throws std::runtime_error with one clear line.
void writeJson(const std::string& path, const nlohmann::ordered_json& json);

/// What people read of one answer, lines with their ends.
std::string answerText(const PlanAnswer& answer);

/// What people read of many answers.
std::string answersText(const std::vector<PlanAnswer>& answers, double preparation_ms);

/// How a query ended, in a line without its end.
std::string headline(const PlanAnswer& answer);

/// The smallest value that at least a share 0..1 of the values does not exceed; NaN of nothing.
double nearestRank(std::vector<double> values, double share);

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
