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
  double distance_share = 1.0;    ///< [1] of the distance to the goal that the heuristic counts
  double heuristic_weight = 1.3;  ///< [1] 1 = shortest time, more = found sooner
  double turn_weight = 0.8;       ///< [1] of the time to turn towards the way to the goal
  double reverse_penalty = 0.5;   ///< [1] of the time spent reversing
  double stop_penalty = 0.5;      ///< [s] for coming to rest on the way
  double near_penalty = 0.5;      ///< [1] of the time spent as near to something as possible
  double near_distance = 0.9;     ///< [m] of clearance from which on nothing is near
  double switch_penalty = 0.6;    ///< [s] for leaving the plan that was made before
  /// [s] farther ahead nothing needs to be planned: by then the robot has chosen anew six times. 0
  /// = the time of six patterns that join others; Teodor's are 9 s, a Jackal's 4.2.
  double horizon = 0.0;
  double least_rate = 0.3;  ///< [1] of the best speed that a plan to the horizon must gain on the
                            ///< distance to the goal; below that it is looked ahead twice as far
  double frontier = 2.5;    ///< [m] before the unknown a plan may end
  double least_progress = 0.3;  ///< [s] of time to go that a plan must gain
  int escape_patterns = 3;      ///< so many patterns may be needed to leave blocked ground
  double goal_share = 0.7;      ///< [1] of the goal's tolerance that is aimed for
  ShockCostConfig shock;        ///< what being shaken costs
  double top_speed = kNoLimit;  ///< [m/s] faster patterns are not used, but those that stop
  int improvements = 0;         ///< more searches after the first plan, each for a better one; the
                                ///< last has weight 1 and ends when there is none
  size_t most_nodes = 6'000'000;  ///< [1] of 88 bytes each; a search that needs more is cut off
};

/// Rules of another planner that replace footprint, margins and penalties (see tools/lab/plan).
class EdgeRules {
 public:
  virtual ~EdgeRules() = default;
  /// Whether a pattern may begin in a heading bin.
  virtual bool mayBegin(const TablePattern& pattern, int heading_bin) const = 0;
  /// Cost of a pattern begun at a point [m]; infinite where it is blocked.
  virtual float cost(double x, double y, const TablePattern& pattern) const = 0;
};

/// What to search for.
struct SearchProblem {
  Pose2 T_map_start;
  int start_class = 0;
  Uncertainty start_uncertainty;  ///< where the start is predicted; in map axes
  const PatternTable* patterns = nullptr;
  const CollisionChecker* collision_checker = nullptr;
  const DistanceToGoal* distance_to_goal = nullptr;  ///< nullptr = straight to the goal
  /// If given, it replaces distance_share and turn_weight. PathPlanner gives it: of 500 queries on
  /// five whole maps 462 have a plan after 100 ms, without it 444 (turn_weight at its best). The
  /// robot does without: its plans would take 5 to 7 ms more each, where their search takes 0.7 ms,
  /// and it is at the goal no sooner and no more often (tests/bench/RESULTS.md).
  const HeadingAwareHeuristic* heading_heuristic = nullptr;
  const GroundCost* ground = nullptr;  ///< nullptr = all ground costs the same
  const EdgeRules* rules = nullptr;    ///< if given, in the place of the collision checker
  Goal goal;
  /// [m/s2] that a stop may count on: after each pattern the vehicle must be able to slide to a
  /// stop, unless that takes less than 10 cm or it leaves blocked ground.
  double deceleration = kNoLimit;
  bool little_room = false;    ///< with CollisionChecker::leastLevel()
  double cell = 0.0;           ///< [m] in the place of SearchConfig::cell; 0 = as configured
  std::vector<int> committed;  ///< ids of the patterns that the plan before wanted from here on
  /// Ids of the patterns that the plan has to begin with; the margin for checking is enough for
  /// them.
  std::vector<int> branch;
  /// The branch is the last plan: it is checked with the planning margin, or with Margins::narrow
  /// where that is configured.
  bool branch_is_plan = false;
  /// Told whenever a plan, or a cheaper one, was found, with its cost.
  std::function<void(double cost, int expansions)> on_better;
};

/// Says whether the search must end now, from the number of expansions: a deadline or a count.
using StopPredicate = std::function<bool(int expansions)>;

/// How a search ended.
enum class SearchEnd {
  kGoal,      ///< the plan ends at rest in the goal
  kHorizon,   ///< it ends as far ahead as needed, or where the unknown begins
  kProgress,  ///< stopped or all seen: the best that was found, nearer to the goal than the start
  kNothing    ///< no pattern is free, or none brings the goal nearer
};

/// A pattern of a plan and where it is expected to end.
struct PlanStep {
  int pattern_id = 0;
  Pose2 T_map_end;
  int exit_class = 0;
  double time = 0.0;        ///< [s] since the start of the plan
  Uncertainty uncertainty;  ///< of the end, in map axes
};

/// The step that a pattern makes, begun where another one ended.
PlanStep stepAfter(const PlanStep& before, const TablePattern& pattern);

struct SearchResult {
  SearchEnd end = SearchEnd::kNothing;
  std::vector<PlanStep> steps;
  double cost = 0.0;        ///< [s] of the steps, with penalties
  double expected = 0.0;    ///< [s] inflated heuristic from there on
  double time_to_go = 0.0;  ///< [s] of the steps, and the distance from there on at the best speed
  double distance_to_go = 0.0;  ///< [m] from the end of the plan
  int expansions = 0;
  bool exhausted = false;  ///< the whole space was searched: no better plan at this resolution
  Reason reason;           ///< why there is nothing
};

/// A node of the search tree, for drawing.
struct TreeNode {
  int parent = -1;
  int pattern_id = -1;
  Pose2 T_map_body;
  double time = 0.0;
};

/// A state that the search has reached.
struct SearchNode {
  double x, y;
  float yaw;  // within -pi..pi
  float cos_yaw, sin_yaw;
  float cost;        // g [s]
  float time;        // without penalties [s]
  float admissible;  // heuristic: least cost from here to the goal [s]
  float inflated;    // heuristic that orders the open list [s]
  int parent;
  int number;  // of its expansion; -1 before
  const TablePattern* by;
  int16_t depth;
  int16_t on_plan;  // patterns in common with the committed plan; -1 = left it
  int8_t motion_class;
  int8_t repeats;   // of the pattern that led here
  int8_t level;     // margin with which its end is free; -1 while on blocked ground
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

/// What drives one search of an anytime run.
struct SearchWeights {
  float heuristic = 1.0F;
  float turn = 0.0F;

  bool exact() const { return heuristic <= 1.0F && turn <= 0.0F; }
};

/// What a step of a plan costs, and what is left from a node to the goal. A new cost term goes
/// here.
class CostModel {
 public:
  /// Cost from a node to the goal [s].
  struct Heuristic {
    float admissible;  ///< never more than the true cost
    float inflated;    ///< orders the open list
  };

  CostModel() = default;
  /// `problem` must outlive this.
  CostModel(const SearchConfig& config, const SearchProblem& problem);
  void setWeights(const SearchWeights& weights) { weights_ = weights; }
  const SearchWeights& weights() const { return weights_; }
  /// [m/s] of the fastest pattern.
  double bestSpeed() const { return speed_; }

  /// Cost of a pattern from a node to the node where it ends, without switchPenalty().
  float edgeCost(const SearchNode& parent, const TablePattern& pattern,
                 const SearchNode& end) const;
  bool staysOnPlan(const SearchNode& parent, const TablePattern& pattern) const;
  /// For leaving the committed plan; less the later it is left.
  float switchPenalty(const SearchNode& parent, const TablePattern& pattern) const;
  /// `on_blocked_ground`: whoever leaves it may go straight to the goal.
  Heuristic heuristic(const SearchNode& node, bool on_blocked_ground) const;
  /// Cost of coming to rest from a motion class [s], for the order of the open list; 0 in exact
  /// searches.
  /** In the goal no distance is left: without it every state around is expanded before a stop. */
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
  float distance_share_ = 1.0F;          // of it that the inflated heuristic counts
  float slack_ = 0.0F;                   // [m] by which the distance may be too long
  float aimed_ = 0.0F;                   // [m] around the goal where a plan must end
  std::vector<float> to_rest_;           // [s] by motion class
};

/// Decides whether a node may be reached: its pattern is free, and the vehicle can stop after it.
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
  /// Whether it may slide on, as it moves at the end of its pattern, until the ground has stopped
  /// it.
  bool slidesFreely(const SearchNode& node) const;
  /// Level of margin for a pattern: that of its own uncertainty and, where it is the next one, of
  /// its start's.
  /** What the patterns before a later one will be off by is known when it becomes the next one; it
   * is planned again then, from where they led. */
  int levelOf(const SearchNode& parent, const TablePattern& pattern) const;

  const SearchProblem* problem_ = nullptr;
  int escape_patterns_ = 0;
};

}  // namespace tread::planner
