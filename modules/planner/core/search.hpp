// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "modules/planner/core/cost_to_go.hpp"
#include "modules/planner/core/node_table.hpp"
#include "modules/planner/core/pattern_table.hpp"
#include "modules/planner/core/surroundings.hpp"

namespace tread::planner {

/// How the search weighs and when it is content.
struct SearchConfig {
  double cell = 0.12;            ///< [m] side of a cell of the search space
  int heading_bins = 60;         ///< of a full turn
  double bound_share = 1.0;      ///< [1] of the way to go that counts; CostToGo::kShare for a bound
  double bound_weight = 1.3;     ///< [1] 1 = shortest time, more = found sooner
  double turn_weight = 0.8;      ///< [1] of the time to turn towards the way to go; 0 for a bound
  double reverse_penalty = 0.5;  ///< [1] of the time spent reversing
  double stop_penalty = 0.5;     ///< [s] for coming to rest on the way
  double near_penalty = 0.5;     ///< [1] of the time spent as near to something as possible
  double near_distance = 0.9;    ///< [m] of clearance from which on nothing is near
  double switch_penalty = 0.6;   ///< [s] for leaving the plan that was made before
  double horizon = 9.0;          ///< [s] farther ahead nothing needs to be planned
  double least_rate = 0.3;  ///< [1] of the best speed that a plan to the horizon must gain on the
                            ///< way to go; below that it is looked ahead twice as far
  double frontier = 2.5;    ///< [m] before the unknown a plan may end
  double least_progress = 0.3;  ///< [s] of time to go that a plan must gain
  int escape_patterns = 3;      ///< so many patterns may be needed to leave blocked ground
  double goal_share = 0.7;      ///< [1] of the goal's tolerance that is aimed for
};

/// What to search for.
struct SearchProblem {
  Pose2 T_map_start;
  int start_class = 0;
  double start_variance = 0.0;  ///< [m2] of the start's position, where it is predicted
  const PatternTable* patterns = nullptr;
  const Surroundings* surroundings = nullptr;
  const CostToGo* cost_to_go = nullptr;
  Goal goal;
  std::vector<int> committed;  ///< ids of the patterns that the plan before wanted from here on
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
  double time = 0.0;      ///< [s] since the start of the plan
  double variance = 0.0;  ///< [m2] of the end's position
};

struct SearchResult {
  SearchEnd end = SearchEnd::kNothing;
  std::vector<PlanStep> steps;
  double cost = 0.0;        ///< [s] of the steps, with penalties
  double time_to_go = 0.0;  ///< [s] the steps, and from there on the bound
  double way_to_go = 0.0;   ///< [m] from the end of the plan
  int expansions = 0;
  std::string reason;  ///< why there is nothing, in words
};

/// A node of the search tree, for drawing.
struct TreeNode {
  int parent = -1;
  int pattern_id = -1;
  Pose2 T_map_body;
  double time = 0.0;
};

/// A* over joinable patterns that collide with nothing.
/** 1. A node is a continuous pose, an exit class and a time; of the nodes in one cell, heading bin
 * and class only the cheapest is expanded.
 *  2. Nodes are checked when they are taken, not when they are made: the pattern's sweep with a
 * margin that grows with the uncertainty gathered, and, unless at rest, that a pattern to stop is
 * free from there. So whatever is returned can stop after each of its patterns.
 *  3. Cost is time and penalties; the bound is the way to go at the best speed of the set. With
 * weight 1, share CostToGo::kShare and no turn weight the plan to a goal is the cheapest there is
 * at the resolution.
 *  4. It ends at the goal (at rest), at the horizon, near the unknown, or when it is told to.
 *  5. From a start that is not free only patterns that never overlap more than the start does are
 * taken. */
class Search {
 public:
  explicit Search(const SearchConfig& config) : config_(config) {}

  SearchResult run(const SearchProblem& problem, const StopPredicate& stop);

  /// The nodes that were expanded in the last run, best branch included, at most `count`.
  std::vector<TreeNode> tree(size_t count) const;
  /// Indices in that tree of the last result's branch, root first.
  const std::vector<int>& branch() const { return branch_; }
  const SearchConfig& config() const { return config_; }

 private:
  struct Node {
    double x, y, yaw;
    float cost;      // g [s]
    float time;      // without penalties [s]
    float to_go;     // h [s], weighted
    float variance;  // [m2]
    int parent;
    const TablePattern* by;
    int16_t depth;
    int16_t on_plan;  // patterns in common with the committed plan; -1 = left it
    int8_t motion_class;
    int8_t level;  // margin with which its end is free; -1 while on blocked ground
    bool expanded;
    Overlap overlap;  // on blocked ground

    Pose2 pose() const { return {x, y, yaw}; }
  };
  struct Open {
    float estimate;
    int node;
  };

  void begin(const SearchProblem& problem);
  int take();
  void push(int node);
  bool admit(Node& node);
  bool freeFromParent(Node& node) const;
  bool canStop(const Node& node) const;
  void expand(int parent);
  void addChild(int parent, const TablePattern& pattern);
  float edgeCost(const TablePattern& pattern, const Pose2& end) const;
  float switchPenalty(const Node& parent, const TablePattern& pattern) const;
  float toGo(const Pose2& pose) const;
  bool isGoal(const Node& node) const;
  bool isFarEnough(const Node& node) const;
  int bestLeaf() const;
  uint64_t keyOf(const Node& node) const;
  SearchResult finish(int leaf, SearchEnd end);

  SearchConfig config_;
  const SearchProblem* problem_ = nullptr;
  std::vector<Node> nodes_;
  std::vector<Open> open_;
  NodeTable best_;
  std::vector<int> leaf_to_root_;
  mutable std::vector<int> branch_;
  int expansions_ = 0;
  double way_at_start_ = 0.0;
  double speed_ = 1.0;
  double turn_rate_ = 1.0;
};

}  // namespace tread::planner
