// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <optional>
#include <string>

#include "modules/planner/core/map/coarse_clearance.hpp"
#include "modules/planner/core/search/pattern_search.hpp"

namespace tread::planner {

/// How plans are made on a map that does not change.
struct PathConfig {
  FootprintSize footprint;
  SearchConfig search = pathSearch();
  double guide_beyond = 0.15;  ///< [1] of the cost at the start that it is filled in beyond it
  DistanceFieldConfig field = pathDistanceField();
  bool unknown_blocks = true;
  double grown = 0.0;  ///< [m] by which obstacles were grown already: for a round robot, a point
  /// The whole way at once, the cheapest there is, and nothing but time and turns counts.
  static SearchConfig pathSearch();
  static DistanceFieldConfig pathDistanceField();
};

/// From where to where; all in the frame of the map.
struct PathQuery {
  Pose2 T_map_start;
  Pose2 T_map_goal;
  double position_tolerance = 0.25;  ///< [m] > 0
  double yaw_tolerance = 0.26;       ///< [rad] > 0; pi or more = any heading
  /// A goal to which there is no way is replaced by the place nearest to it at which the disc
  /// inside the footprint has room, with any heading; where the vehicle does not get there, by what
  /// is within its outermost corner of that (the paper's "come as close as possible").
  bool come_close = false;

  Goal goal() const { return {1, T_map_goal, position_tolerance, yaw_tolerance}; }
};

/// What became of a query.
enum class PathEnd {
  kSolved,
  kUnreachable,  ///< it is certain that there is none: see PathPlanner
  kNoneInTime    ///< none was found before the search was told to stop, or at its resolution
};

/// Called while a query is answered, for those who measure.
struct PathEvents {
  std::function<void()> search_begins;  ///< the way to go is worked out
  /// A plan, or a better one; one that comes closer to a goal that cannot be reached may cost more.
  std::function<void(double cost, int expansions)> better_plan;
};

struct PathAnswer {
  PathEnd end = PathEnd::kNoneInTime;
  std::string reason;   ///< why there is none to the goal itself, in words; empty if there is one
  SearchResult search;  ///< its steps lead to the goal, or as near to it as was found
  /// Where the vehicle could stand nearest to an unreachable goal, in p_map.
  std::optional<Eigen::Vector2d> closest;
};

/// Plans on a map that does not change, for one vehicle and one set of patterns.
/** What all queries share is worked out once: clearance, passages, connected areas. Unreachable is
 * only what is certain: the goal lies outside the map or where not even the disc inside the
 * footprint has room, that disc cannot be moved from start to goal, or no pattern can begin at the
 * start; on a lattice also that all states were seen. A start on blocked ground is connected to
 * all that the patterns may reach that may lead off it (SearchConfig::escape_patterns). */
class PathPlanner {
 public:
  PathPlanner(const Grid& grid, const PatternTable& patterns, const PathConfig& config);
  /// For a point that drives over cells with costs: SBPL's own problem (see CellCosts). `bins`:
  /// headings of the lattice; the goal is one cell and one heading.
  PathPlanner(const CellCosts& costs, double cell_size, int bins, const PatternTable& patterns);

  /// `stop` is asked with 0 expansions while the way is worked out, too.
  PathAnswer answer(const PathQuery& query, const StopPredicate& stop,
                    const PathEvents& events = {});
  /// Only the first part of answer(): whether the goal is certainly unreachable, and why.
  std::optional<PathAnswer> refusal(const PathQuery& query) const;

  const PatternSearch& search() const { return search_; }
  /// Whether the footprint is free at a pose.
  bool isFree(const Pose2& T_map_body) const;
  /// [m] of the disc inside the footprint, around the body's origin.
  double inscribedRadius() const { return inscribed_; }

 private:
  std::optional<PathAnswer> refusalOfAreas(const PathQuery& query) const;
  PathAnswer withoutWay(const PathQuery& query, const DistanceToGoal& way,
                        const StopPredicate& stop, const PathEvents& events);
  PathAnswer comeClose(const PathQuery& query, const PathAnswer& refusal, const StopPredicate& stop,
                       const PathEvents& events);
  void placeOnLattice(SearchProblem& problem) const;
  SearchProblem problemOf(const PathQuery& query) const;
  std::vector<int> areasFrom(const Pose2& T_map_start) const;
  std::vector<int> areasAround(const Eigen::Vector2d& p_goal, double tolerance) const;
  bool anyBegins(const Pose2& T_map_start) const;
  void classify(PathAnswer& answer) const;
  DistanceToGoal wayTo(const SearchProblem& problem, const Interruption& interruption) const;

  static constexpr const char* kNoneBeginsReason =
      "the start has no legal successor: each pattern would leave the map or hit something";
  /// A cell's corner may have so much more room than its centre, in cells.
  static constexpr double kMostSlack = 0.71;

  const PatternTable& patterns_;
  PathConfig config_;
  PatternSearch search_;
  double inscribed_ = 0.0;
  std::optional<CollisionChecker> checker_;
  std::optional<FreeConfigurations> configurations_;
  std::optional<CoarseClearance> clearances_;
  const CellCosts* costs_ = nullptr;
  double cell_size_ = 0.0;
};

}  // namespace tread::planner
