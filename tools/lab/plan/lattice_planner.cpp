// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/plan/lattice_planner.hpp"

#include <cmath>

namespace tread::plan {
namespace {

using planner::PathAnswer;
using planner::PathEnd;

planner::SearchConfig latticeSearch(double cell_size, int bins) {
  planner::SearchConfig config = planner::PathConfig::pathSearch();
  config.cell = cell_size;
  config.heading_bins = bins;
  config.heuristic_weight = 1.0;
  config.turn_weight = 0.0;
  config.improvements = 0;
  config.most_nodes = 40'000'000;
  return config;
}

PathAnswer refused(const std::string& reason) {
  PathAnswer answer;
  answer.end = PathEnd::kUnreachable;
  answer.reason = reason;
  return answer;
}

}  // namespace

float LatticeRules::cost(double x, double y, const planner::TablePattern& pattern) const {
  const int worst =
      costs_.worst(cellAt(x, y), primitives_[static_cast<size_t>(pattern.id())].cells);
  return worst < 0 ? planner::kNever : static_cast<float>(pattern.cost * (worst + 1));
}

CellIndex LatticeRules::cellAt(double x, double y) const {
  return {static_cast<int>(std::floor(x * per_cell_)), static_cast<int>(std::floor(y * per_cell_))};
}

LatticePlanner::LatticePlanner(const CellCosts& costs, double cell_size, int bins,
                               const std::vector<SearchPrimitive>& primitives)
    : cell_size_(cell_size),
      patterns_({primitives.begin(), primitives.end()}, planner::SweepResolution{}),
      rules_(costs, cell_size, primitives),
      search_(latticeSearch(cell_size, bins)) {}

PathAnswer LatticePlanner::answer(const planner::PathQuery& query,
                                  const planner::StopPredicate& stop,
                                  const planner::PathEvents& events) {
  if (!rules_.isFree(query.T_map_start.position())) return refused("the start lies on obstacles");
  if (!rules_.isFree(query.T_map_goal.position())) return refused("the goal lies on obstacles");
  planner::SearchProblem problem;
  problem.T_map_start = query.T_map_start;
  problem.start_class = patterns_.restClass();
  problem.patterns = &patterns_;
  problem.goal = query.goal();
  problem.rules = &rules_;
  placeOnLattice(problem);
  problem.on_better = events.better_plan;
  if (events.search_begins) events.search_begins();
  PathAnswer answer;
  answer.search = search_.run(problem, stop);
  if (answer.search.end == planner::SearchEnd::kGoal) {
    answer.end = PathEnd::kSolved;
  } else if (!answer.search.exhausted) {
    answer.reason = planner::kStoppedReason;
  } else {
    answer.end = PathEnd::kUnreachable;
    answer.reason = answer.search.expansions <= 1 ? planner::kNoneBeginsReason
                                                  : planner::exhaustedReason(answer.search);
  }
  return answer;
}

/// The lattice has discrete cells and headings: start and goal are moved to their centres.
void LatticePlanner::placeOnLattice(planner::SearchProblem& problem) const {
  const double bin = 2.0 * kPi / search_.config().heading_bins;
  for (Pose2* pose : {&problem.T_map_start, &problem.goal.T_map_goal}) {
    pose->x = (std::floor(pose->x / cell_size_) + 0.5) * cell_size_;
    pose->y = (std::floor(pose->y / cell_size_) + 0.5) * cell_size_;
    pose->yaw = std::round(pose->yaw / bin) * bin;
  }
  problem.goal.position_tolerance = 0.25 * cell_size_;
  problem.goal.yaw_tolerance = 0.4 * bin;
}

}  // namespace tread::plan
