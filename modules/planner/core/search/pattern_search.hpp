// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <limits>
#include <string>
#include <vector>

#include "modules/planner/core/map/collision_checker.hpp"
#include "modules/planner/core/map/distance_to_goal.hpp"
#include "modules/planner/core/map/heading_aware_heuristic.hpp"
#include "modules/planner/core/search/cell_costs.hpp"
#include "modules/planner/core/search/pattern_table.hpp"
#include "modules/planner/core/search/search_containers.hpp"

namespace tread::planner {

/// How the search weighs and when it is content.
struct SearchConfig {
  double cell = 0.12;     ///< [m] side of a cell of the search space
  int heading_bins = 60;  ///< of a full turn
  double distance_share =
      1.0;  ///< [1] of the way to go that counts; DistanceToGoal::kAdmissibleShare for a bound
  double heuristic_weight = 1.3;  ///< [1] 1 = shortest time, more = found sooner
  double turn_weight = 0.8;       ///< [1] of the time to turn towards the way to go; 0 for a bound
  double reverse_penalty = 0.5;   ///< [1] of the time spent reversing
  double stop_penalty = 0.5;      ///< [s] for coming to rest on the way
  double turn_penalty = 0.0;      ///< [s/rad] of net turn
  double near_penalty = 0.5;      ///< [1] of the time spent as near to something as possible
  double near_distance = 0.9;     ///< [m] of clearance from which on nothing is near
  double unknown_penalty = 0.0;   ///< [1] of the time spent where nothing is known, if one may
  double switch_penalty = 0.6;    ///< [s] for leaving the plan that was made before
  double horizon = 9.0;           ///< [s] farther ahead nothing needs to be planned
  double least_rate = 0.3;  ///< [1] of the best speed that a plan to the horizon must gain on the
                            ///< way to go; below that it is looked ahead twice as far
  double frontier = 2.5;    ///< [m] before the unknown a plan may end
  double least_progress = 0.3;  ///< [s] of time to go that a plan must gain
  int escape_patterns = 3;      ///< so many patterns may be needed to leave blocked ground
  double goal_share = 0.7;      ///< [1] of the goal's tolerance that is aimed for
  int improvements = 0;         ///< more searches after the first plan, each for a better one; the
                                ///< last has weight 1 and ends when there is none
  size_t most_nodes = 6'000'000;  ///< [1] of 112 bytes each; a search that needs more is cut off
};

/// What to search for.
struct SearchProblem {
  Pose2 T_map_start;
  int start_class = 0;
  Uncertainty start_uncertainty;  ///< where the start is predicted; in map axes
  const PatternTable* patterns = nullptr;
  const CollisionChecker* collision_checker = nullptr;
  const DistanceToGoal* distance_to_goal = nullptr;  ///< nullptr = straight to the goal
  const HeadingAwareHeuristic* heading_heuristic =
      nullptr;                            ///< if given the guide, in the place of the turn weight
  const CellCosts* cell_costs = nullptr;  ///< if given a point drives over these, not a footprint
  Goal goal;
  double cell = 0.0;           ///< [m] in the place of SearchConfig::cell; 0 = as configured
  std::vector<int> committed;  ///< ids of the patterns that the plan before wanted from here on
  /// Ids of the patterns that the plan has to begin with; the margin for checking is enough for
  /// them.
  std::vector<int> branch;
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
  double expected = 0.0;    ///< [s] and from there on, as the search weighs it
  double time_to_go = 0.0;  ///< [s] the steps, and from there on the bound
  double way_to_go = 0.0;   ///< [m] from the end of the plan
  int expansions = 0;
  bool exhausted = false;  ///< everything was seen: there is nothing better at this resolution
  std::string reason;      ///< why there is nothing, in words
};

/// A node of the search tree, for drawing.
struct TreeNode {
  int parent = -1;
  int pattern_id = -1;
  Pose2 T_map_body;
  double time = 0.0;
};

/// Anytime A* over joinable patterns that collide with nothing.
/** 1. A node is a continuous pose, an exit class and a time; of the nodes in one cell, heading bin
 * and class the cheapest is kept; a pattern too short to leave its cell is repeated. It takes the
 * other's place while that one waits, and joins it when that one has been expanded.
 *  2. A node is made only if its pattern's sweep is free, with a margin that grows with the
 * uncertainty gathered, and if, unless at rest, a pattern to stop is free from there. So whatever
 * is returned can stop after each of its patterns.
 *  3. Cost is time and penalties; the bound is the way to go at what a metre costs at least, and
 * the turn to the goal's heading at what a radian costs at least.
 *  4. The first search is greedy (heuristic_weight, turn_weight). Each of the `improvements` that
 * follow begins anew with weights nearer to 1 and keeps out of what cannot become cheaper than the
 * best plan; the last one ends with the cheapest plan there is at the resolution.
 *  5. It ends at the goal (at rest), at the horizon, near the unknown, or when it is told to.
 *  6. From a start that is not free only patterns that never overlap more than the start does are
 * taken. */
class PatternSearch {
 public:
  explicit PatternSearch(const SearchConfig& config) : config_(config) {}

  SearchResult run(const SearchProblem& problem, const StopPredicate& stop);

  /// The nodes that were expanded in the last run, best branch included, at most `count`.
  std::vector<TreeNode> tree(size_t count) const;
  /// Indices in that tree of the last result's branch, root first.
  const std::vector<int>& branch() const { return branch_; }
  const SearchConfig& config() const { return config_; }
  /// [bytes] that the last run needed.
  size_t bytes() const;

 private:
  struct Node {
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
    int8_t repeats;           // of the pattern that led here
    int8_t level;             // margin with which its end is free; -1 while on blocked ground
    Overlap overlap;          // on blocked ground
    Uncertainty uncertainty;  // in map axes

    TurnedPose pose() const {
      return {x, y, static_cast<double>(cos_yaw), static_cast<double>(sin_yaw)};
    }
    bool expanded() const { return number >= 0; }
    Pose2 plainPose() const { return {x, y, static_cast<double>(yaw)}; }
  };
  struct Child {
    Node node;
    uint64_t key;
  };
  /// What drives one search of an anytime run.
  struct Weights {
    float heuristic = 1.0F;
    float turn = 0.0F;

    bool exact() const { return heuristic <= 1.0F && turn <= 0.0F; }
  };
  /// Cost from a node to the goal: a lower bound, and the estimate that orders the open list.
  struct Heuristic {
    float admissible;
    float inflated;
  };
  enum class RunEnd { kBetterPlan, kExhausted, kStopped };

  void begin(const SearchProblem& problem);
  void prepareHeuristic();
  void beginAgain(const Weights& weights);
  void keepBranch();
  Weights weightsOf(int search) const;
  RunEnd search(const StopPredicate& stop);
  bool visit(int index);
  void keepBest(int leaf, SearchEnd end);
  void expand(int parent);
  static constexpr float kNever = std::numeric_limits<float>::infinity();
  static float wrapped(float yaw) {
    constexpr auto pi = static_cast<float>(kPi);
    while (yaw > pi) yaw -= 2.0F * pi;
    while (yaw < -pi) yaw += 2.0F * pi;
    return yaw;
  }
  Node nodeAfter(const Node& from, const TablePattern& pattern) const;
  void addChild(Node& node, uint64_t key);
  bool leaveCell(const Node& from, Node& node) const;
  bool onBranch(const Node& parent) const;
  bool staysOnPlan(const Node& parent, const TablePattern& pattern) const;
  bool admit(const Node& parent, Node& node) const;
  bool freeFromParent(const Node& parent, Node& node) const;
  bool canStop(const Node& node) const;
  float edgeCost(const Node& parent, const TablePattern& pattern, const Node& end) const;
  float switchPenalty(const Node& parent, const TablePattern& pattern) const;
  Heuristic heuristic(const Node& node, bool on_blocked_ground) const;
  bool isGoal(const Node& node) const;
  bool isFarEnough(const Node& node) const;
  void noteProgress(int index);
  uint64_t keyOf(const Node& node) const;
  int headingBin(const Node& node) const;
  Uncertainty uncertaintyAfter(const Node& parent, const TablePattern& pattern) const;
  SearchResult finish(int leaf, SearchEnd end);
  std::vector<TreeNode> drawn(const std::vector<int>& wanted) const;

  SearchConfig config_;
  const SearchProblem* problem_ = nullptr;
  BlockList<Node> nodes_;
  std::vector<Child> children_;  // of the node that is being expanded
  OpenList open_;
  NodeTable best_;
  Weights weights_;
  std::vector<int> leaf_to_root_;
  mutable std::vector<int> branch_;
  int expansions_ = 0;
  double way_at_start_ = 0.0;
  float inflated_at_start_ = 0.0F;
  double speed_ = 1.0;
  double per_cell_ = 1.0;
  float bins_per_radian_ = 0.0F;
  float first_bin_ = 0.0F;  // so that bins are numbered around 0 rad, rounded and never negative
  float goal_yaw_ = 0.0F;
  float yaw_tolerance_ = 0.0F;
  float metre_cost_[2] = {0.0F, 0.0F};   // [s/m] of the two bounds, see PatternTable::leastCosts()
  float radian_cost_[2] = {0.0F, 0.0F};  // [s/rad]
  float way_share_ = 1.0F;               // of the way to go that is certain
  float slack_ = 0.0F;                   // [m] of it that is not
  float distance_share_ = 1.0F;          // of the way to go that is expected
  size_t kept_ = 0;  // nodes of the best plan of an earlier search, at the front
  int best_leaf_ = -1;
  SearchEnd best_end_ = SearchEnd::kNothing;
  int farthest_ = -1;  // where to go if there is no plan: of what was expanded
  float farthest_value_ = 0.0F;
  uint64_t from_key_ = 0;   // of the node that is being expanded
  float best_cost_ = 0.0F;  // of the best plan, what is left to go included
};

}  // namespace tread::planner
