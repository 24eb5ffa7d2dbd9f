// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "modules/planner/core/map/clearance_map.hpp"
#include "modules/planner/core/search/pattern_search.hpp"

namespace tread::planner {

/// Settings of planning on a static map.
struct PathConfig {
  FootprintSize footprint;
  SearchConfig search = pathSearch();
  /// [1] of the cost at the start by which the heuristic is expanded further
  double heuristic_beyond = 0.15;
  DistanceFieldConfig field = pathDistanceField();
  bool unknown_blocks = true;
  double grown = 0.0;  ///< [m] earlier inflation of obstacles: for a round robot treated as a point
  /// The complete path at once, of least cost, with only time and turns counted.
  static SearchConfig pathSearch();
  static DistanceFieldConfig pathDistanceField();
};

/// Start and goal of a query, in the frame of the map.
struct PathQuery {
  Pose2 T_map_start;
  Pose2 T_map_goal;
  double position_tolerance = 0.25;  ///< [m] > 0
  double yaw_tolerance = 0.26;       ///< [rad] > 0; pi or more = any heading
  /// Replaces an unreachable goal by the place nearest to it where the disc inside the footprint
  /// fits, with any heading; if the vehicle does not get there, by the circle around it described
  /// by its outermost corner (the paper's "come as close as possible").
  bool come_close = false;

  Goal goal() const { return {1, T_map_goal, position_tolerance, yaw_tolerance}; }
};

/// Result of a query.
enum class PathEnd {
  kSolved,
  kUnreachable,  ///< certainly no plan: see PathPlanner
  kNoneInTime    ///< no plan before the search was stopped, or at its resolution
};

/// Callbacks during a query, for measurements.
struct PathEvents {
  std::function<void()> search_begins;  ///< the heuristics are computed
  /// A plan, or a better one; one that comes closer to an unreachable goal may cost more.
  std::function<void(double cost, int expansions)> better_plan;
};

struct PathAnswer {
  PathEnd end = PathEnd::kNoneInTime;
  std::string reason;  ///< why there is no plan to the goal itself, in words; empty if there is one
  SearchResult search;  ///< its steps lead to the goal, or as close to it as was found
  /// Where the vehicle could stand nearest to an unreachable goal, in p_map.
  std::optional<Eigen::Vector2d> closest;
};

inline constexpr const char* kNoneBeginsReason =
    "the start has no legal successor: each pattern would leave the map or hit something";
inline constexpr const char* kStoppedReason = "none was found before the search was stopped";
/// Why a search found no plan although it expanded all states.
std::string exhaustedReason(const SearchResult& result);

/// Plans on a static map, for one vehicle and one set of patterns.
/** Clearance, free configurations and connected areas are computed once for all queries.
 * Unreachable means certainty: the goal lies outside the map or where not even the disc inside the
 * footprint fits, that disc cannot be moved from start to goal, or no pattern can begin at the
 * start. A start on blocked ground counts as connected to every area that
 * SearchConfig::escape_patterns patterns may reach. */
class PathPlanner {
 public:
  PathPlanner(const Grid& grid, const PatternTable& patterns, const PathConfig& config);

  /// `stop` is also polled, with 0 expansions, while the distance is computed.
  PathAnswer answer(const PathQuery& query, const StopPredicate& stop,
                    const PathEvents& events = {});
  /// Only the first part of answer(): whether the goal is certainly unreachable, and why.
  std::optional<PathAnswer> refusal(const PathQuery& query) const;

  const PatternSearch& search() const { return search_; }
  /// Whether the footprint is free at a pose.
  bool isFree(const Pose2& T_map_body) const;

 private:
  std::optional<PathAnswer> refusalOfAreas(const PathQuery& query) const;
  PathAnswer answerWithoutWay(const PathQuery& query, const DistanceToGoal& distance,
                              const StopPredicate& stop, const PathEvents& events);
  PathAnswer comeClose(const PathQuery& query, const PathAnswer& refusal, const StopPredicate& stop,
                       const PathEvents& events);
  SearchProblem problemOf(const PathQuery& query) const;
  std::vector<int> areasFrom(const Pose2& T_map_start) const;
  std::vector<int> areasAround(const Eigen::Vector2d& p_goal, double tolerance) const;
  bool anyBegins(const Pose2& T_map_start) const;
  static void classify(PathAnswer& answer);
  DistanceToGoal distanceTo(const SearchProblem& problem, const Interruption& interruption) const;

  /// A cell's corner may have this much more clearance than its centre, in cells.
  static constexpr double kMostSlack = 0.71;

  const PatternTable& patterns_;
  PathConfig config_;
  PatternSearch search_;
  double inscribed_;  ///< [m] radius of the disc inside the footprint, around the body's origin
  CollisionChecker checker_;
  FreeConfigurations configurations_;
  CoarseClearance coarse_clearance_;
};

}  // namespace tread::planner
