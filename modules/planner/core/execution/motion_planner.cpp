// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/execution/motion_planner.hpp"

#include <utility>

namespace tread::planner {

SearchResult MotionPlanner::plan(const PlanRequest& request, int expansions, Counters& counters) {
  SearchProblem problem;
  problem.T_map_start = request.start.T_map_end;
  problem.start_class = request.start.exit_class;
  problem.start_uncertainty = request.start.uncertainty;
  problem.patterns = request.table.get();
  problem.collision_checker = &request.local_map.collisionChecker();
  problem.distance_to_goal = &request.local_map.distanceToGoal();
  problem.goal = request.local_map.target();
  for (const PlanStep& step : request.last_steps) problem.committed.push_back(step.pattern_id);
  if (searched_table_ != request.table)
    counters["cycles driven until a plan with the newest set"] = cycles_with_old_set_;
  searched_table_ = request.table;
  // Whoever stops a step counts all expansions in it, so that a replay stops at the same one.
  int before = 0;
  bool late = false;
  const StopPredicate enough = [&](int count) {
    late = late || (stop_ && stop_(before + count));
    return late || count >= expansions;
  };
  SearchResult result = search_.run(problem, enough);
  before = result.expansions;
  if (!late && result.end != SearchEnd::kNothing)
    result = keepSide(problem, std::move(result), enough, counters);
  else if (!late && request.may_keep_next)
    result = keepNext(problem, std::move(result), enough, counters);
  ++counters["plans"];
  counters["expansions"] += result.expansions;
  return result;
}

/// The fresh plan, or the best along the branch if that turns to the other side and is as good.
SearchResult MotionPlanner::keepSide(SearchProblem& problem, SearchResult fresh,
                                     const StopPredicate& stop, Counters& counters) {
  problem.branch = side_.opposedBy(fresh.steps, *problem.patterns);
  if (problem.branch.empty()) return fresh;
  SearchResult along = branch_search_.run(problem, stop);
  const int expansions = fresh.expansions + along.expansions;
  fresh.expansions = along.expansions = expansions;
  if (side_.isWorth(fresh, along)) {
    ++counters["turned to the other side"];
    return fresh;
  }
  ++counters["kept to its side"];
  std::swap(search_, branch_search_);
  return along;
}

/// Where there is no plan with the margin for planning, continues with the queued pattern if it is
/// still free with the margin for checking.
SearchResult MotionPlanner::keepNext(SearchProblem& problem, SearchResult fresh,
                                     const StopPredicate& stop, Counters& counters) {
  if (problem.committed.empty()) return fresh;
  problem.branch = {problem.committed.front()};
  SearchResult along = branch_search_.run(problem, stop);
  const int expansions = fresh.expansions + along.expansions;
  fresh.expansions = along.expansions = expansions;
  if (along.end == SearchEnd::kNothing) return fresh;
  ++counters["kept to its next pattern"];
  std::swap(search_, branch_search_);
  return along;
}

}  // namespace tread::planner
