// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "tools/plan/lattice_planner.hpp"
#include "tools/plan/plan_report.hpp"
#include "tools/plan/plan_task.hpp"

namespace tread::plan {

/// Answers queries of a task with the planner's core, and takes the time.
class TaskPlanner {
 public:
  /// Works out what all queries share. Throws std::runtime_error with one line for a pattern set
  /// that nobody can drive with.
  explicit TaskPlanner(const PlanTask& task);

  /// The answer; its total_ms is without preparationMs(). Of the deadline `spent_ms` are over.
  PlanAnswer answer(const PlanQuery& query, double spent_ms = 0.0);
  /// [ms] that patterns, clearance and connected areas took.
  double preparationMs() const { return preparation_ms_; }
  /// What the last query's picture shows.
  PlanScene scene(const PlanQuery& query, const PlanAnswer& answer) const;

 private:
  void prepareLattice();
  void preparePlanner();
  const planner::PatternSearch& search() const {
    return lattice_ ? lattice_->search() : planner_->search();
  }
  const planner::PatternTable& patterns() const {
    return lattice_ ? lattice_->patterns() : *patterns_;
  }
  std::string nameOf(int number) const;
  void tellPlan(const Pose2& T_grid_start, const planner::SearchResult& result,
                PlanAnswer& answer) const;
  ClosestApproach closestApproach(const planner::PathAnswer& found, const PlanQuery& query,
                                  const PlanAnswer& answer) const;

  const PlanTask& task_;
  std::vector<SearchPrimitive> primitives_;  // if those of a file are used
  std::unique_ptr<planner::PatternTable> patterns_;
  std::unique_ptr<planner::PathPlanner> planner_;
  std::unique_ptr<LatticePlanner> lattice_;  // in its place if the primitives are used exactly
  double preparation_ms_ = 0.0;
};

}  // namespace tread::plan
