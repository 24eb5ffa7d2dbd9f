// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/execution/motion_planner.hpp"

#include <cmath>
#include <utility>

namespace tread::planner {
namespace {

std::vector<int> idsOf(const std::vector<PlanStep>& plan) {
  std::vector<int> ids;
  for (const PlanStep& step : plan) ids.push_back(step.pattern_id);
  return ids;
}

bool isCutOff(const SearchResult& result) {
  return result.end == SearchEnd::kProgress;
}

}  // namespace

std::optional<SideHysteresis::Turn> SideHysteresis::turnOf(const std::vector<int>& ids,
                                                           const PatternTable& table) const {
  double time = 0.0;
  for (size_t i = 0; i < ids.size() && time < config_.ahead; ++i) {
    const TablePattern* pattern = table.find(ids[i]);
    if (pattern == nullptr) return std::nullopt;
    const double yaw = pattern->end().pose.yaw;
    if (std::abs(yaw) > config_.turn) return Turn{i, yaw > 0.0};
    time += pattern->duration;
  }
  return std::nullopt;
}

void SideHysteresis::begun(int pattern_id) {
  if (!intended_.empty() && intended_.front() == pattern_id)
    intended_.erase(intended_.begin());
  else
    intended_.clear();
}

void SideHysteresis::take(const std::vector<PlanStep>& plan, const PatternTable& table) {
  std::vector<int> ids = idsOf(plan);
  if (turnOf(ids, table) || !turnOf(intended_, table)) intended_ = std::move(ids);
}

std::vector<int> SideHysteresis::opposedBy(const std::vector<PlanStep>& plan,
                                           const PatternTable& table) const {
  const std::optional<Turn> wanted = turnOf(intended_, table);
  const std::optional<Turn> turn = turnOf(idsOf(plan), table);
  if (!wanted || !turn || wanted->left == turn->left) return {};
  return {intended_.begin(), intended_.begin() + static_cast<std::ptrdiff_t>(wanted->index) + 1};
}

bool SideHysteresis::isWorth(const SearchResult& fresh, const SearchResult& along_branch) const {
  if (along_branch.end == SearchEnd::kNothing) return true;
  if (isCutOff(fresh) != isCutOff(along_branch)) return isCutOff(along_branch);
  // What was cut off ends anywhere: only how near it comes to the goal can be compared.
  if (isCutOff(fresh)) return fresh.expected + config_.gain < along_branch.expected;
  return fresh.cost + fresh.expected + config_.gain < along_branch.cost + along_branch.expected;
}

SearchResult MotionPlanner::plan(const PlanRequest& request, int expansions, Counters& counters) {
  SearchProblem problem;
  problem.T_map_start = request.start.T_map_end;
  problem.start_class = request.start.exit_class;
  problem.start_uncertainty = request.start.uncertainty;
  problem.patterns = request.table.get();
  problem.collision_checker = &request.map.collisionChecker();
  problem.distance_to_goal = &request.map.distanceToGoal();
  problem.goal = request.map.target();
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

/// The best plan along problem.branch; it and the fresh one know the expansions of both.
SearchResult MotionPlanner::alongBranch(const SearchProblem& problem, const StopPredicate& stop,
                                        SearchResult& fresh) {
  SearchResult along = branch_search_.run(problem, stop);
  fresh.expansions += along.expansions;
  along.expansions = fresh.expansions;
  return along;
}

/// The fresh plan, or the best along the branch if that turns to the other side and is as good.
SearchResult MotionPlanner::keepSide(SearchProblem& problem, SearchResult fresh,
                                     const StopPredicate& stop, Counters& counters) {
  problem.branch = side_.opposedBy(fresh.steps, *problem.patterns);
  if (problem.branch.empty()) return fresh;
  SearchResult along = alongBranch(problem, stop, fresh);
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
  SearchResult along = alongBranch(problem, stop, fresh);
  if (along.end == SearchEnd::kNothing) return fresh;
  ++counters["kept to its next pattern"];
  std::swap(search_, branch_search_);
  return along;
}

}  // namespace tread::planner
