// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <cmath>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "modules/planner/core/map/clearance_map.hpp"
#include "modules/planner/core/map/collision_checker.hpp"
#include "modules/planner/core/map/distance_to_goal.hpp"
#include "modules/planner/core/search/pattern_search.hpp"
#include "modules/planner/core/search/pattern_table.hpp"
#include "modules/planner/core/search/plan_risk.hpp"

namespace tread::planner {

/// A number of at least 0 for messages, such as "3.5".
inline std::string withTenths(double value) {
  const auto tenths = std::lround(10.0 * value);
  return std::to_string(tenths / 10) + "." + std::to_string(tenths % 10);
}

/// How the planner keeps and interprets the map.
struct PlanningMapConfig {
  FootprintSize footprint;
  Margins margins;
  ClearanceMapConfig clearance;
  DistanceFieldConfig field;
  double window = 24.0;             ///< [m] side of the square in which collisions are checked
  int64_t window_period = 100'000;  ///< [us] least time between two extractions of that square
  int64_t field_period = 400'000;   ///< [us] least time between two updates of the distance
  bool unknown_blocks = true;       ///< whether unknown ground may not be driven on
  double full_speed = 0.0;          ///< [m/s]
  double stopping_time = 0.5;       ///< [s] at its speed that it goes on after a zero command
  std::vector<Fence> fences;        ///< the robot's own
  bool come_close = false;  ///< drive close to goals that obstacles enclose, instead of standing
};

/// The received map, and the data derived from it on demand: collision checker and distance to
/// goal.
class PlanningMap {
 public:
  explicit PlanningMap(const PlanningMapConfig& config)
      : config_(config), fences_(config.fences), stopping_time_(config.stopping_time) {}

  /// Takes a tile; a map of another cell size replaces the present one. False if the tile is
  /// malformed.
  bool put(Tile tile, double cell_size, int tile_cells);
  bool empty() const { return !map_ || map_->empty(); }
  /// [us] of the newest scan in the map; 0 if there is none.
  int64_t newestUtime() const { return map_ ? map_->newestUtime() : 0; }

  /// The fences in force, the robot's own included.
  void setFences(const std::vector<Fence>& fences) {
    fences_ = fences;
    fenced_changed_ = true;
  }
  /// Adds a polygon to keep out of that was found by driving; the oldest of many is forgotten.
  void keepOut(const Fence& found);
  /// [s] learned; at least half of the configured value.
  void setStoppingTime(double seconds);
  /// Weight of a metre on ground of each cost in the distance to the goal [m].
  void setSlowness(const std::array<float, kCostMax + 1>& slowness);
  /// Standard deviation of the position per axis [m]; NaN = not measured.
  void setPositionStd(double std);
  /// Why fences forbid the goal, in words; empty if they do not. Needs updateDistance().
  const std::string& fencedGoal() const { return fenced_goal_; }
  /// The reason for an unreachable goal: obstacles may move, or may never have been there.
  StopReason whyUnreachable() const {
    const bool enclosed = goal_enclosed_ || distance_to_goal_.enclosed();
    return fenced_goal_.empty() && enclosed ? StopReason::kNoWayFound
                                            : StopReason::kGoalUnreachable;
  }

  /// Updates the collision checker if the map changed or the vehicle moved. Needs a map.
  /** Unknown ground under the vehicle becomes free, because it stands there. */
  void updateCollisionChecker(const Pose2& T_map_body, int64_t now);
  /// Updates the distance to the goal. Needs updateCollisionChecker().
  void updateDistance(const Pose2& T_map_body, const Goal& goal, int64_t now);
  /// Makes a place more expensive until the goal changes.
  void addDetour(const Eigen::Vector2d& p_map);
  /// The narrowest place a short distance ahead becomes a detour; after `most` all are forgotten.
  void addDetourAhead(const Eigen::Vector2d& p_vehicle, int most);
  size_t detours() const { return detours_.size(); }
  void forgetDetours();

  const CollisionChecker& collisionChecker() const { return *checker_; }
  const DistanceToGoal& distanceToGoal() const { return distance_to_goal_; }
  /// The target to drive to: the goal or, with come_close, the reachable place nearest to an
  /// unreachable one. Needs updateDistance().
  const Goal& target() const { return target_; }
  /// Why the target is not the goal, in words; empty if it is.
  const std::string& goalSubstitutionReason() const { return goal_substitution_reason_; }
  const PlanningMapConfig& config() const { return config_; }

 private:
  void fenceIn();
  void computeDistance(const Goal& goal, const Eigen::Vector2d& p_vehicle);
  std::string whyFenced(const Goal& goal) const;
  void assumeFreeUnder(const Pose2& T_map_body);
  bool sameGoal(const Goal& goal) const;
  void substituteGoal(const Eigen::Vector2d& p_vehicle,
                      const std::optional<Eigen::Vector2d>& before);

  PlanningMapConfig config_;
  std::optional<ClearanceMap> map_;
  std::vector<Fence> fences_;
  std::vector<Fence> found_;      ///< to keep out of
  double position_growth_ = 0.0;  ///< [m]
  double stopping_time_ = 0.0;    ///< [s]
  bool fenced_changed_ = true;
  FencedGround fenced_;
  FencedGround no_fences_;
  std::string fenced_goal_;
  bool field_fenced_ = false;
  std::optional<CollisionChecker> checker_;
  Eigen::Vector2d p_window_{0.0, 0.0};
  int64_t window_revision_ = -1;
  int64_t window_time_ = 0;
  DistanceToGoal distance_to_goal_;
  std::optional<Goal> field_goal_;
  Goal target_;
  std::string goal_substitution_reason_;
  bool goal_enclosed_ = false;  ///< obstacles are the reason for the substitute goal
  int64_t field_revision_ = -1;
  Eigen::Vector2d p_field_{0.0, 0.0};
  int64_t field_time_ = 0;
  bool weights_changed_ = false;
  std::vector<Detour> detours_;
};

/// When the planner may change the side to which it turns.
struct SideHysteresisConfig {
  /// [s] by which a plan to the other side must be cheaper; 0 = any cheaper one
  double gain = 4.0;
  double turn = 0.12;  ///< [rad] a pattern that turns more decides the side of a plan
  double ahead = 3.0;  ///< [s] if it begins within this time from the start of the plan
};

/// Remembers to which side the vehicle is about to turn, and compares plans to the other side with
/// it.
/** It stores the last plan that had a side, and removes patterns from it as they start, so that it
 * always begins at the end of the running pattern. Plans without a side leave it unchanged: left,
 * straight on and right is a change of side, too. */
class SideHysteresis {
 public:
  explicit SideHysteresis(const SideHysteresisConfig& config) : config_(config) {}

  /// The bridge has started a pattern.
  void begun(int pattern_id);
  void forget() { intended_.clear(); }
  /// Takes the plan that is now followed.
  void take(const std::vector<PlanStep>& plan, const PatternTable& table);
  /// Ids of the patterns with which a plan must begin to turn to the remembered side; empty if the
  /// given plan does not turn to the other one.
  std::vector<int> opposedBy(const std::vector<PlanStep>& plan, const PatternTable& table) const;
  /// Whether a fresh plan is sufficiently better than the best one along the branch.
  /** A plan that leads somewhere is better than one that was cut off. */
  bool isWorth(const SearchResult& fresh, const SearchResult& along_branch) const;

 private:
  /// The pattern of a sequence that decides its side: its index, or none.
  struct Turn {
    size_t index = 0;
    bool left = false;
  };
  std::optional<Turn> turnOf(const std::vector<int>& ids, const PatternTable& table) const;

  SideHysteresisConfig config_;
  std::vector<int> intended_;  ///< ids from the end of the running pattern on
};

/// Start and inputs of a plan.
struct PlanRequest {
  std::shared_ptr<const PatternTable> table;
  const PlanningMap& map;
  const GroundCost* ground;  ///< nullptr = all ground costs the same
  const PlanStep& start;     ///< the end of the running pattern, or the pose at standstill
  const std::vector<PlanStep>& last_steps;  ///< of the last plan, from there on
  SearchEnd last_end;                       ///< of the search for it
  bool may_keep_next;                       ///< a pattern runs: its queued successor may be kept
  double deceleration = kNoLimit;           ///< [m/s2] available on this ground
  double reaction = 0.0;                    ///< [s] see RiskQuestion
};

/// A plan, and its risk of contact.
struct PlannedWay : SearchResult {
  PlanRisk risk;
};

/// Searches for plans, and prefers the side to which the last plan turned.
class MotionPlanner {
 public:
  using Counters = std::map<std::string, int64_t>;

  MotionPlanner(const SearchConfig& search, const SideHysteresisConfig& side)
      : search_(search), branch_search_(search), side_(side) {}

  /// May end searches before the limit on expansions.
  void setStop(const StopPredicate& stop) { stop_ = stop; }
  PlannedWay plan(const PlanRequest& request, int expansions, Counters& counters);

  SideHysteresis& side() { return side_; }
  const PatternSearch& search() const { return search_; }
  /// Call once a cycle with the set in use.
  void countCycle(const std::shared_ptr<const PatternTable>& table, bool driving) {
    if (searched_table_ != table && driving) ++cycles_with_old_set_;
  }
  void setReplaced() { cycles_with_old_set_ = 0; }

 private:
  SearchResult search(const PlanRequest& request, int expansions, Counters& counters);
  SearchResult alongBranch(const SearchProblem& problem, const StopPredicate& stop,
                           SearchResult& fresh);
  SearchResult keepPlan(SearchProblem& problem, SearchResult fresh, const StopPredicate& stop,
                        Counters& counters);
  SearchResult withLittleRoom(SearchProblem& problem, SearchResult fresh, const StopPredicate& stop,
                              Counters& counters);
  SearchResult keepSide(SearchProblem& problem, SearchResult fresh, const StopPredicate& stop,
                        Counters& counters);
  SearchResult keepNext(SearchProblem& problem, SearchResult fresh, const StopPredicate& stop,
                        Counters& counters);

  PatternSearch search_;
  PatternSearch branch_search_;  ///< for a prescribed branch
  SideHysteresis side_;
  StopPredicate stop_;
  /// Of the last search: its tree, which is published later, points into it.
  std::shared_ptr<const PatternTable> searched_table_;
  int cycles_with_old_set_ = 0;  ///< since the newest set was taken
};

}  // namespace tread::planner
