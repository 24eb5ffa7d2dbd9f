// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <limits>
#include <utility>

#include "modules/planner/core/execution/supervisor.hpp"

namespace tread::planner {

SearchResult Supervisor::searchFrom(const PlannerInputs& s, const PlanStep& start, int expansions) {
  SearchProblem problem;
  problem.T_map_start = start.T_map_end;
  problem.start_class = start.exit_class;
  problem.start_uncertainty = start.uncertainty;
  problem.patterns = table_.get();
  problem.collision_checker = &local_map_.collisionChecker();
  problem.distance_to_goal = &local_map_.distanceToGoal();
  problem.goal = local_map_.target();
  for (const PlanStep& step : plan_) problem.committed.push_back(step.pattern_id);
  if (searched_table_ != table_)
    counters_["cycles driven until a plan with the newest set"] = cycles_with_old_set_;
  searched_table_ = table_;
  // Whoever stops a step counts all expansions in it, so that a replay stops at the same one.
  int before = 0;
  bool late = false;
  const StopPredicate enough = [&](int count) {
    late = late || (stop_ && stop_(before + count));
    return late || count >= expansions;
  };
  SearchResult result = search_.run(problem, enough);
  before = result.expansions;
  if (!late && result.end == SearchEnd::kNothing)
    result = keepNext(problem, std::move(result), enough);
  else if (!late)
    result = keepSide(problem, std::move(result), enough);
  last_plan_ = s.now;
  planned_ = true;
  expansions_ = result.expansions;
  plan_end_ = result.end;
  time_to_go_ = result.end == SearchEnd::kNothing ? std::numeric_limits<double>::quiet_NaN()
                                                  : result.time_to_go;
  ++counters_["plans"];
  counters_["expansions"] += result.expansions;
  return result;
}

/// The fresh plan, or the best along the branch if that turns to the other side and is as good.
SearchResult Supervisor::keepSide(SearchProblem& problem, SearchResult fresh,
                                  const StopPredicate& stop) {
  problem.branch = hysteresis_.opposedBy(fresh.steps, *table_);
  if (problem.branch.empty()) return fresh;
  SearchResult along = branch_search_.run(problem, stop);
  const int expansions = fresh.expansions + along.expansions;
  fresh.expansions = along.expansions = expansions;
  if (hysteresis_.isWorth(fresh, along)) {
    ++counters_["turned to the other side"];
    return fresh;
  }
  ++counters_["kept to its side"];
  std::swap(search_, branch_search_);
  return along;
}

/// Where there is no plan with the margin for planning, what was about to follow the running
/// pattern is gone on with if it is still free with the margin for checking.
SearchResult Supervisor::keepNext(SearchProblem& problem, SearchResult fresh,
                                  const StopPredicate& stop) {
  if (runningPattern() == nullptr || plan_.empty()) return fresh;
  problem.branch = {plan_.front().pattern_id};
  SearchResult along = branch_search_.run(problem, stop);
  const int expansions = fresh.expansions + along.expansions;
  fresh.expansions = along.expansions = expansions;
  if (along.end == SearchEnd::kNothing) return fresh;
  ++counters_["kept to its next pattern"];
  std::swap(search_, branch_search_);
  return along;
}

}  // namespace tread::planner
