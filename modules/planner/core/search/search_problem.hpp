// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "common/execution/stop_reason.hpp"
#include "modules/planner/core/map/collision_checker.hpp"
#include "modules/planner/core/map/distance_to_goal.hpp"
#include "modules/planner/core/map/ground_cost.hpp"
#include "modules/planner/core/map/heading_aware_heuristic.hpp"
#include "modules/planner/core/search/pattern_table.hpp"

namespace tread::planner {

inline constexpr double kNoLimit = 100.0;

/// Resolution, weights and penalties of the search, and when a plan is long enough.
struct SearchConfig {
  double cell = 0.12;             ///< [m] side of a cell of the search space
  int heading_bins = 60;          ///< of a full turn
  double distance_share = 1.0;    ///< [1] of the distance to the goal that enters the heuristic
  double heuristic_weight = 1.3;  ///< [1] 1 = shortest time, more = faster search
  double turn_weight = 0.8;       ///< [1] of the time to turn towards the path to the goal
  double reverse_penalty = 0.5;   ///< [1] of the time spent reversing
  double stop_penalty = 0.5;      ///< [s] for coming to rest on the path
  double near_penalty = 0.5;      ///< [1] of the time spent at zero clearance
  double near_distance = 0.9;     ///< [m] of clearance from which the penalty is zero
  double switch_penalty = 0.6;    ///< [s] for leaving the previous plan
  /// [s] planning horizon: by then the robot has chosen six more times. 0 = the time of six
  /// patterns that join others; Teodor's are 9 s, a Jackal's 4.2.
  double horizon = 0.0;
  double least_rate = 0.3;      ///< [1] of the best speed with which a plan to the horizon must
                                ///< approach the goal; otherwise the horizon is doubled
  double frontier = 2.5;        ///< [m] before the unknown, where a plan may end
  double least_progress = 0.3;  ///< [s] of time to go that a plan must gain
  int escape_patterns = 3;      ///< number of patterns that may be needed to leave blocked ground
  double goal_share = 0.7;      ///< [1] of the goal's tolerance used as target
  ShockCostConfig shock;        ///< cost of shock
  double top_speed = kNoLimit;  ///< [m/s] faster patterns are used only to stop
  int improvements = 0;  ///< further searches after the first plan, each for a better one; the last
                         ///< has weight 1 and ends when there is none
  size_t most_nodes = 6'000'000;  ///< [1] of 88 bytes each; a search that needs more is stopped
};

/// Rules of another planner that replace footprint, margins and penalties (see tools/lab/plan).
class EdgeRules {
 public:
  virtual ~EdgeRules() = default;
  /// Whether a pattern may start in a heading bin.
  virtual bool mayBegin(const TablePattern& pattern, int heading_bin) const = 0;
  /// Cost of a pattern started at a point [m]; infinite if it is blocked.
  virtual float cost(double x, double y, const TablePattern& pattern) const = 0;
};

/// The search problem.
struct SearchProblem {
  Pose2 T_map_start;
  int start_class = 0;
  Uncertainty start_uncertainty;  ///< of the predicted start, in map axes
  const PatternTable* patterns = nullptr;
  const CollisionChecker* collision_checker = nullptr;
  const DistanceToGoal* distance_to_goal = nullptr;  ///< nullptr = straight-line distance
  /// If given, it replaces distance_share and turn_weight. PathPlanner gives it: of 500 queries on
  /// five whole maps 462 have a plan after 100 ms, without it 444 (turn_weight at its best). The
  /// robot does without: its plans would take 5 to 7 ms more each, where their search takes 0.7 ms,
  /// and it would reach the goal neither sooner nor more often (tests/bench/RESULTS.md).
  const HeadingAwareHeuristic* heading_heuristic = nullptr;
  const GroundCost* ground = nullptr;  ///< nullptr = all ground costs the same
  const EdgeRules* rules = nullptr;    ///< if given, replaces the collision checker
  Goal goal;
  /// [m/s2] reliable when stopping: after each pattern the vehicle must be able to slide to a stop,
  /// unless that takes less than 10 cm or it leaves blocked ground.
  double deceleration = kNoLimit;
  bool little_room = false;    ///< with CollisionChecker::leastLevel()
  double cell = 0.0;           ///< [m] replaces SearchConfig::cell; 0 = as configured
  std::vector<int> committed;  ///< ids of the patterns of the previous plan from here on
  /// Ids of the patterns with which the plan must begin; they need only the margin for checking.
  std::vector<int> branch;
  /// The branch is the last plan: it is checked with the planning margin, or with Margins::narrow
  /// if that is configured.
  bool branch_is_plan = false;
  /// Called with the cost of each plan that is the first or cheaper.
  std::function<void(double cost, int expansions)> on_better;
};

/// Whether the search must end now, given the number of expansions: a deadline or a limit.
using StopPredicate = std::function<bool(int expansions)>;

/// How a search ended.
enum class SearchEnd {
  kGoal,      ///< the plan ends at rest in the goal
  kHorizon,   ///< it ends as far ahead as needed, or where the unknown begins
  kProgress,  ///< stopped or exhausted: the best plan found, closer to the goal than the start
  kNothing    ///< no pattern is free, or none leads closer to the goal
};

/// A pattern of a plan and its expected end.
struct PlanStep {
  int pattern_id = 0;
  Pose2 T_map_end;
  int exit_class = 0;
  double time = 0.0;        ///< [s] since the start of the plan
  Uncertainty uncertainty;  ///< of the end, in map axes
};

/// The step of a pattern that starts where another one ended.
PlanStep stepAfter(const PlanStep& before, const TablePattern& pattern);

struct SearchResult {
  SearchEnd end = SearchEnd::kNothing;
  std::vector<PlanStep> steps;
  double cost = 0.0;            ///< [s] of the steps, with penalties
  double expected = 0.0;        ///< [s] inflated heuristic at the end
  double time_to_go = 0.0;      ///< [s] of the steps, plus the remaining distance at the best speed
  double distance_to_go = 0.0;  ///< [m] from the end of the plan
  int expansions = 0;
  /// The whole space was searched: there is no better plan at this resolution
  bool exhausted = false;
  Reason reason;  ///< why there is no plan
};

/// A node of the search tree, for drawing.
struct TreeNode {
  int parent = -1;
  int pattern_id = -1;
  Pose2 T_map_body;
  double time = 0.0;
};

/// A state reached by the search.
struct SearchNode {
  double x, y;
  float yaw;  // within -pi..pi
  float cos_yaw, sin_yaw;
  float cost;        // g [s]
  float time;        // without penalties [s]
  float admissible;  // heuristic: least cost from here to the goal [s]
  float inflated;    // heuristic that orders the open list [s]
  int parent;
  int number;  // of its expansion; -1 if not expanded
  const TablePattern* by;
  int16_t depth;
  int16_t on_plan;  // patterns in common with the committed plan; -1 = diverged from it
  int8_t motion_class;
  int8_t repeats;   // repetitions of the pattern that led here
  int8_t level;     // margin level at which its end is free; -1 while on blocked ground
  Overlap overlap;  // on blocked ground

  TurnedPose pose() const {
    return {x, y, static_cast<double>(cos_yaw), static_cast<double>(sin_yaw)};
  }
  bool expanded() const { return number >= 0; }
  Pose2 plainPose() const { return {x, y, static_cast<double>(yaw)}; }
};

constexpr float kNever = std::numeric_limits<float>::infinity();

/// An angle within half a turn [rad].
inline float wrapped(float yaw) {
  constexpr auto pi = static_cast<float>(kPi);
  while (yaw > pi) yaw -= 2.0F * pi;
  while (yaw < -pi) yaw += 2.0F * pi;
  return yaw;
}

/// Weights of one search of an anytime run.
struct SearchWeights {
  float heuristic = 1.0F;
  float turn = 0.0F;

  bool exact() const { return heuristic <= 1.0F && turn <= 0.0F; }
};

/// Cost of a step of a plan, and of the rest from a node to the goal. New cost terms are added
/// here.
class CostModel {
 public:
  /// Cost from a node to the goal [s].
  struct Heuristic {
    float admissible;  ///< never above the true cost
    float inflated;    ///< orders the open list
  };

  CostModel() = default;
  /// `problem` must outlive this.
  CostModel(const SearchConfig& config, const SearchProblem& problem);
  void setWeights(const SearchWeights& weights) { weights_ = weights; }
  const SearchWeights& weights() const { return weights_; }
  /// [m/s] of the fastest pattern.
  double bestSpeed() const { return speed_; }

  /// Cost of a pattern from a node to the node at its end, without switchPenalty().
  float edgeCost(const SearchNode& parent, const TablePattern& pattern,
                 const SearchNode& end) const;
  bool staysOnPlan(const SearchNode& parent, const TablePattern& pattern) const;
  /// For leaving the committed plan; smaller the later it is left.
  float switchPenalty(const SearchNode& parent, const TablePattern& pattern) const;
  /// `on_blocked_ground`: a vehicle that leaves it may head straight for the goal.
  Heuristic heuristic(const SearchNode& node, bool on_blocked_ground) const;
  /// Cost of coming to rest from a motion class [s], for ordering the open list; 0 in exact
  /// searches.
  /** In the goal no distance remains: without this cost every state around is expanded before a
   * stop. */
  float costToRest(int motion_class) const {
    return weights_.exact() ? 0.0F : to_rest_[static_cast<size_t>(motion_class)];
  }

 private:
  std::vector<float> costsToRest() const;

  SearchConfig config_;
  const SearchProblem* problem_ = nullptr;
  SearchWeights weights_;
  double speed_ = 1.0;
  float goal_yaw_ = 0.0F;
  float yaw_tolerance_ = 0.0F;
  float metre_cost_[2] = {0.0F, 0.0F};   // [s/m] see PatternTable::leastCosts()
  float radian_cost_[2] = {0.0F, 0.0F};  // [s/rad]
  float admissible_share_ = 1.0F;        // of the distance to the goal
  float distance_share_ = 1.0F;          // of it that the inflated heuristic uses
  float slack_ = 0.0F;                   // [m] by which the distance may be overestimated
  float aimed_ = 0.0F;                   // [m] around the goal where a plan must end
  std::vector<float> to_rest_;           // [s] by motion class
};

/// Decides whether a node is admissible: its pattern is free, and the vehicle can stop after it.
class NodeChecker {
 public:
  NodeChecker() = default;
  /// `problem` must outlive this.
  NodeChecker(const SearchConfig& config, const SearchProblem& problem)
      : problem_(&problem), escape_patterns_(config.escape_patterns) {}

  /// Checks a node and fills in its level, overlap and uncertainty.
  bool admit(const SearchNode& parent, SearchNode& node) const;
  /// Whether the pattern after a node is prescribed.
  bool onBranch(const SearchNode& parent) const {
    return static_cast<size_t>(parent.depth) < problem_->branch.size();
  }

 private:
  bool freeFromParent(const SearchNode& parent, SearchNode& node) const;
  bool canStop(const SearchNode& node) const;
  /// Whether it may slide on, with the motion at the end of its pattern, until the ground has
  /// stopped it.
  bool slidesFreely(const SearchNode& node) const;
  /// Level of margin for a pattern: by its own uncertainty and, if it is the next one, by that of
  /// its start.
  /** The errors of the patterns before a later one are known when it becomes the next one; it is
   * then planned again from where they led. */
  int levelOf(const SearchNode& parent, const TablePattern& pattern) const;

  const SearchProblem* problem_ = nullptr;
  int escape_patterns_ = 0;
};

}  // namespace tread::planner
