// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/search/path_planner.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tread::planner {
namespace {

/// A coarse cell is at most this share of the disc inside the footprint, so that walls stay walls.
constexpr double kCoarseShare = 0.5;
/// Room that a cell may have beyond that at its centre, in cells, as a rule.
constexpr double kUsualSlack = 0.25;
/// So often the cells of the search are halved where all was seen and no plan found.
constexpr int kFiner = 2;
SearchConfig latticeSearch(double cell_size, int bins) {
  SearchConfig config = PathConfig::pathSearch();
  config.cell = cell_size;
  config.heading_bins = bins;
  config.heuristic_weight = 1.0;
  config.turn_weight = 0.0;
  config.improvements = 0;
  config.most_nodes = 40'000'000;
  return config;
}

bool isWanting(const SearchResult& result) {
  return result.exhausted && result.end != SearchEnd::kGoal && result.expansions > 1;
}

}  // namespace

SearchConfig PathConfig::pathSearch() {
  SearchConfig config;
  config.cell = 0.1;
  config.heading_bins = 72;
  config.heuristic_weight = 3.0;
  config.reverse_penalty = config.stop_penalty = config.switch_penalty = 0.0;
  config.near_penalty = 0.0;
  config.horizon = 1e6;
  config.frontier = -1.0;
  config.least_rate = 0.0;
  config.goal_share = 1.0;
  config.improvements = 3;
  return config;
}

DistanceFieldConfig PathConfig::pathDistanceField() {
  DistanceFieldConfig config;
  config.tight_weight = 0.0;
  config.max_distance = 1e4;
  config.reach = 3.0;
  return config;
}

PathPlanner::PathPlanner(const Grid& grid, const PatternTable& patterns, const PathConfig& config)
    : patterns_(patterns), config_(config), search_(config.search) {
  const FootprintSize& size = config.footprint;
  inscribed_ = std::max(0.0, std::min({size.front, size.rear, size.half_width}));
  Margins none;
  none.check = none.plan = none.growth = none.largest = 0.0;
  checker_.emplace(grid, size, none, config.unknown_blocks);
  configurations_.emplace(*checker_, inscribed_, config.grown);
  const double cell = grid.cellSize();
  const int largest = std::max({1, grid.width(), grid.height()});
  const int coarse =
      std::clamp(static_cast<int>(kCoarseShare * (inscribed_ + config.grown) / cell), 1, largest);
  clearances_.emplace(grid, checker_->field(), coarse);
  clearances_->label(inscribed_ - kMostSlack * cell);
}

PathPlanner::PathPlanner(const CellCosts& costs, double cell_size, int bins,
                         const PatternTable& patterns)
    : patterns_(patterns),
      search_(latticeSearch(cell_size, bins)),
      costs_(&costs),
      cell_size_(cell_size) {}

bool PathPlanner::isFree(const Pose2& T_map_body) const {
  if (costs_ == nullptr) return checker_->isFree(T_map_body, CollisionChecker::kBare);
  return costs_->at({static_cast<int>(std::floor(T_map_body.x / cell_size_)),
                     static_cast<int>(std::floor(T_map_body.y / cell_size_))}) >= 0;
}

SearchProblem PathPlanner::problemOf(const PathQuery& query) const {
  SearchProblem problem;
  problem.T_map_start = query.T_map_start;
  problem.start_class = patterns_.restClass();
  problem.patterns = &patterns_;
  problem.goal = query.goal();
  return problem;
}

DistanceToGoal PathPlanner::wayTo(const SearchProblem& problem,
                                  const Interruption& interruption) const {
  const Eigen::Vector2d p_start = problem.T_map_start.position();
  DistanceFieldConfig config = config_.field;
  DistanceToGoal way;
  for (const double slack : {kUsualSlack, kMostSlack}) {
    config.inflation = std::max(0.0, inscribed_ - slack * checker_->grid().cellSize());
    // At last a coarse cell counts as in the goal if any point of it may be.
    Goal goal = problem.goal;
    if (slack == kMostSlack) goal.position_tolerance += kMostSlack * clearances_->coarseSize();
    way.compute(*clearances_, goal, p_start, {}, config, interruption);
    if (!way.unreachable()) break;
  }
  return way;
}

PathAnswer PathPlanner::answer(const PathQuery& query, const StopPredicate& stop,
                               const PathEvents& events) {
  if (std::optional<PathAnswer> refusal = this->refusal(query))
    return query.come_close && refusal->closest ? comeClose(query, *refusal, stop, events)
                                                : *refusal;
  SearchProblem problem = problemOf(query);
  DistanceToGoal way;
  HeadingAwareHeuristic guide;
  if (costs_ == nullptr) {
    const Interruption interruption = [&stop] { return stop(0); };
    way = wayTo(problem, interruption);
    if (way.unreachable() && isFree(query.T_map_start)) return withoutWay(query, way, stop, events);
    problem.collision_checker = &*checker_;
    problem.distance_to_goal = &way;
    guide = HeadingAwareHeuristic(*configurations_, problem.goal, problem.T_map_start,
                                  motionRates(patterns_), config_.guide_beyond, interruption);
    if (!guide.empty() && guide.reached()) problem.heading_heuristic = &guide;
  } else {
    placeOnLattice(problem);
  }
  problem.on_better = events.better_plan;
  if (events.search_begins) events.search_begins();
  PathAnswer answer;
  answer.search = search_.run(problem, stop);
  // Where the vehicle has to manoeuvre in little space, cells may hide the moves that it takes.
  for (int finer = 0; finer < kFiner && isWanting(answer.search) && costs_ == nullptr; ++finer) {
    const int before = answer.search.expansions;
    if (stop(before)) {
      answer.search.exhausted = false;  // finer cells were not looked at
      break;
    }
    problem.cell = (problem.cell > 0.0 ? problem.cell : config_.search.cell) / 2.0;
    answer.search = search_.run(problem, [&](int count) { return stop(before + count); });
    answer.search.expansions += before;
  }
  classify(answer);
  if (answer.end != PathEnd::kSolved && !isFree(query.T_map_start))
    answer.reason += "; the start lies on obstacles";
  return answer;
}

/// Cells and headings are numbers there: start and goal are moved to the middle of theirs.
void PathPlanner::placeOnLattice(SearchProblem& problem) const {
  const double bin = 2.0 * kPi / search_.config().heading_bins;
  for (Pose2* pose : {&problem.T_map_start, &problem.goal.T_map_goal}) {
    pose->x = (std::floor(pose->x / cell_size_) + 0.5) * cell_size_;
    pose->y = (std::floor(pose->y / cell_size_) + 0.5) * cell_size_;
    pose->yaw = std::round(pose->yaw / bin) * bin;
  }
  problem.goal.position_tolerance = 0.25 * cell_size_;
  problem.goal.yaw_tolerance = 0.4 * bin;
  problem.cell_costs = costs_;
}

void PathPlanner::classify(PathAnswer& answer) const {
  const SearchResult& result = answer.search;
  if (result.end == SearchEnd::kGoal) {
    answer.end = PathEnd::kSolved;
    return;
  }
  if (!result.exhausted) {
    answer.reason = "none was found before the search was stopped";
    return;
  }
  const bool none_begins = costs_ != nullptr && result.expansions <= 1;
  // A lattice has no other states than those that were looked at.
  if (none_begins || costs_ != nullptr) answer.end = PathEnd::kUnreachable;
  answer.reason = none_begins
                      ? kNoneBeginsReason
                      : "the goal is not among all that the patterns lead to, " +
                            std::to_string(result.expansions) + " expansions at this resolution";
}

}  // namespace tread::planner
