// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "modules/planner/core/search/search_containers.hpp"
#include "modules/planner/core/search/search_problem.hpp"

namespace tread::planner {

/// Cells, heading bins and motion classes: of the nodes in one, the cheapest is kept.
class StateGrid {
 public:
  StateGrid() = default;
  StateGrid(double cell, int heading_bins);

  int headingBin(const SearchNode& node) const {
    // Yaw is within half a turn, so bins run from half of the number to one and a half times it.
    int bin = static_cast<int>(node.yaw * bins_per_radian_ + first_bin_);
    while (bin >= heading_bins_) bin -= heading_bins_;
    return bin;
  }
  uint64_t keyOf(const SearchNode& node) const {
    return cellBits(node.x) | cellBits(node.y) << 20U |
           static_cast<uint64_t>(headingBin(node)) << 40U |
           static_cast<uint64_t>(node.motion_class) << 48U;
  }

 private:
  uint64_t cellBits(double coordinate) const {
    const double cells = coordinate * per_cell_;
    const auto whole = static_cast<int64_t>(cells);
    return static_cast<uint64_t>(whole - static_cast<int64_t>(cells < static_cast<double>(whole))) &
           0xFFFFFU;
  }

  double per_cell_ = 1.0;
  int heading_bins_ = 1;
  float bins_per_radian_ = 0.0F;
  float first_bin_ = 0.0F;  // numbers bins around 0 rad, rounded and never negative
};

/// Anytime A* over joinable, collision-free patterns.
/** 1. A node is a continuous pose, an exit class and a time; of the nodes in one cell, heading bin
 *    and class the cheapest is kept; a pattern too short to leave its cell is repeated. A cheaper
 *    node replaces one that waits, and is added beside one that has been expanded.
 *  2. A node is created only if its pattern's sweep is free, with a margin that grows with the
 *     pattern's uncertainty, and if, unless at rest, a pattern to stop is free from there. So
 *     every returned plan can stop after each of its patterns.
 *  3. Cost is time and penalties; the admissible heuristic is the distance to the goal at the
 *     least cost of a metre, and the turn to the goal's heading at the least cost of a radian.
 *  4. The first search is greedy (heuristic_weight, turn_weight). Each of the `improvements` after
 *     it restarts with weights closer to 1 and prunes what cannot become cheaper than the best
 *     plan; the last one ends with the cheapest plan at the resolution.
 *  5. It ends at the goal (at rest), at the horizon, near the unknown, or when it is stopped.
 *  6. From a start that is not free only patterns are used that never overlap more than the start
 *     does. */
class PatternSearch {
 public:
  explicit PatternSearch(const SearchConfig& config) : config_(config) {}

  SearchResult run(const SearchProblem& problem, const StopPredicate& stop);

  /// The nodes that were expanded in the last run, including the best branch, at most `count`.
  std::vector<TreeNode> tree(size_t count) const;
  /// Indices in that tree of the last result's branch, root first.
  const std::vector<int>& branch() const { return branch_; }
  const SearchConfig& config() const { return config_; }

 private:
  using Node = SearchNode;
  struct Child {
    Node node;
    uint64_t key;
  };
  /// A plan found so far.
  struct Plan {
    int leaf = -1;
    SearchEnd end = SearchEnd::kNothing;
    float cost = kNever;  // with the admissible heuristic of the leaf
  };
  /// Fallback without a plan: the expanded node with the least value.
  struct Progress {
    int leaf = -1;
    float value = 0.0F;
  };
  enum class RunEnd { kBetterPlan, kExhausted, kStopped };

  void begin(const SearchProblem& problem);
  void beginAgain(const SearchWeights& weights);
  void keepBestBranch();
  SearchWeights weightsOf(int search) const;
  RunEnd search(const StopPredicate& stop);
  bool visit(int index);
  void keepBest(int leaf, SearchEnd end);
  void expand(int parent);
  Node nodeAfter(const Node& from, const TablePattern& pattern) const;
  void addChild(Node& node, uint64_t key);
  bool leaveCell(const Node& from, Node& node) const;
  bool isGoal(const Node& node) const;
  bool isFarEnough(const Node& node) const;
  void noteProgress(int index);
  SearchResult finish(int leaf, SearchEnd end);
  std::vector<TreeNode> drawn(const std::vector<int>& wanted) const;

  SearchConfig config_;
  const SearchProblem* problem_ = nullptr;
  CostModel costs_;
  NodeChecker checker_;
  StateGrid grid_;
  BlockList<Node> nodes_;
  std::vector<Child> children_;  // of the node being expanded
  uint64_t from_key_ = 0;        // of that node
  OpenList open_;
  NodeTable best_;
  Plan plan_;
  Progress progress_;
  size_t kept_ = 0;  // nodes of the best plan of an earlier search, at the front
  std::vector<int> leaf_to_root_;
  mutable std::vector<int> branch_;
  int expansions_ = 0;
  double horizon_ = 0.0;  // [s]
  double distance_at_start_ = 0.0;
  float inflated_at_start_ = 0.0F;
};

}  // namespace tread::planner
