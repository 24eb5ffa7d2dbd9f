// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "modules/planner/core/search/cost_model.hpp"

namespace tread::planner {

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
  Uncertainty uncertaintyAfter(const SearchNode& parent, const TablePattern& pattern) const;

  const SearchProblem* problem_ = nullptr;
  int escape_patterns_ = 0;
};

}  // namespace tread::planner
