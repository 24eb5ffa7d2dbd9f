// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/search/path_planner.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace tread::planner {
namespace {

/// A coarse cell is at most this share of the disc inside the footprint, so that walls stay closed.
constexpr double kCoarseShare = 0.5;
/// Usual excess of a cell's clearance over that at its centre, in cells.
constexpr double kUsualSlack = 0.25;
/// How often the search's cells are halved after an exhausted search without a plan.
constexpr int kFiner = 2;
/// Goals with more cells across are checked with coarse cells.
constexpr double kLargeGoal = 100.0;
/// More distant goals are on no map, and their cells have no indices [m].
constexpr double kFarthest = 1e7;

PathAnswer refused(const std::string& reason) {
  PathAnswer answer;
  answer.end = PathEnd::kUnreachable;
  answer.reason = reason;
  return answer;
}

double insideRadius(const FootprintSize& size) {
  return std::max(0.0, std::min({size.front, size.rear, size.half_width}));
}

Margins noMargins() {
  Margins none;
  none.check = none.plan = none.growth = none.largest = 0.0;
  return none;
}

int coarseCells(const Grid& grid, double radius) {
  const int largest = std::max({1, grid.width(), grid.height()});
  return std::clamp(static_cast<int>(kCoarseShare * radius / grid.cellSize()), 1, largest);
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
    : patterns_(patterns),
      config_(config),
      search_(config.search),
      inscribed_(insideRadius(config.footprint)),
      checker_(grid, config.footprint, noMargins(), config.unknown_blocks),
      configurations_(checker_, inscribed_, config.grown),
      coarse_clearance_(grid, checker_.field(), coarseCells(grid, inscribed_ + config.grown)) {
  coarse_clearance_.label(inscribed_ - kMostSlack * grid.cellSize());
}

bool PathPlanner::isFree(const Pose2& T_map_body) const {
  return checker_.isFree(T_map_body, CollisionChecker::kBare);
}

SearchProblem PathPlanner::problemOf(const PathQuery& query) const {
  SearchProblem problem;
  problem.T_map_start = query.T_map_start;
  problem.start_class = patterns_.restClass();
  problem.patterns = &patterns_;
  problem.goal = query.goal();
  return problem;
}

DistanceToGoal PathPlanner::distanceTo(const SearchProblem& problem,
                                       const Interruption& interruption) const {
  const Eigen::Vector2d p_start = problem.T_map_start.position();
  DistanceFieldConfig config = config_.field;
  DistanceToGoal way;
  for (const double slack : {kUsualSlack, kMostSlack}) {
    config.inflation = std::max(0.0, inscribed_ - slack * checker_.grid().cellSize());
    // Finally a coarse cell counts as in the goal if any point of it may be.
    Goal goal = problem.goal;
    if (slack == kMostSlack) goal.position_tolerance += kMostSlack * coarse_clearance_.coarseSize();
    way.compute(coarse_clearance_, goal, p_start, {}, config, interruption);
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
  const Interruption interruption = [&stop] { return stop(0); };
  const DistanceToGoal distance = distanceTo(problem, interruption);
  if (distance.unreachable() && isFree(query.T_map_start))
    return answerWithoutWay(query, distance, stop, events);
  problem.collision_checker = &checker_;
  problem.distance_to_goal = &distance;
  const HeadingAwareHeuristic heuristic(configurations_, problem.goal, problem.T_map_start,
                                        motionRates(patterns_), config_.heuristic_beyond,
                                        interruption);
  if (!heuristic.empty() && heuristic.reached()) problem.heading_heuristic = &heuristic;
  problem.on_better = events.better_plan;
  if (events.search_begins) events.search_begins();
  PathAnswer answer;
  answer.search = search_.run(problem, stop);
  // If the vehicle must manoeuvre in little space, cells may hide the necessary moves.
  for (int finer = 0; finer < kFiner && isWanting(answer.search); ++finer) {
    const int before = answer.search.expansions;
    if (stop(before)) {
      answer.search.exhausted = false;  // finer cells were not searched
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

/// Whether the search solved the query, and if not, why.
void PathPlanner::classify(PathAnswer& answer) {
  if (answer.search.end == SearchEnd::kGoal)
    answer.end = PathEnd::kSolved;
  else
    answer.reason = answer.search.exhausted ? exhaustedReason(answer.search) : kStoppedReason;
}

std::string exhaustedReason(const SearchResult& result) {
  return "the goal is not among all that the patterns lead to, " +
         std::to_string(result.expansions) + " expansions at this resolution";
}

std::optional<PathAnswer> PathPlanner::refusal(const PathQuery& query) const {
  if (!std::isfinite(query.T_map_start.yaw)) return refused("the start's heading is no number");
  if (!std::isfinite(query.T_map_goal.yaw)) return refused("the goal's heading is no number");
  if (!(query.T_map_goal.position().norm() < kFarthest))
    return refused("the goal lies outside the map");
  if (!(query.position_tolerance > 0.0) || !(query.yaw_tolerance > 0.0))
    return refused("the goal's tolerances are not above 0");
  return refusalOfAreas(query);
}

std::optional<PathAnswer> PathPlanner::refusalOfAreas(const PathQuery& query) const {
  const Eigen::Vector2d p_start = query.T_map_start.position();
  const Eigen::Vector2d p_goal = query.T_map_goal.position();
  if (!checker_.grid().contains(checker_.grid().indexOf(p_start)))
    return refused("the start lies outside the map");
  const std::vector<int> from = areasFrom(query.T_map_start);
  const std::vector<int> to = areasAround(p_goal, query.position_tolerance);
  const bool connected = std::any_of(from.begin(), from.end(), [&](int area) {
    return std::find(to.begin(), to.end(), area) != to.end();
  });
  // No computation is needed for a start that no pattern can leave.
  if (connected && (isWithin(query.goal(), query.T_map_start, config_.search.goal_share) ||
                    anyBegins(query.T_map_start)))
    return std::nullopt;
  if (connected) return refused(kNoneBeginsReason);
  PathAnswer answer = refused("obstacles enclose the goal or the vehicle");
  if (from.empty())
    answer.reason = "the start lies on obstacles";
  else if (!checker_.grid().contains(checker_.grid().indexOf(p_goal)))
    answer.reason = "the goal lies outside the map";
  else if (to.empty())
    answer.reason = "the goal lies on obstacles, or too near to them";
  answer.closest = coarse_clearance_.nearestIn(from, p_goal);
  return answer;
}

/// Numbers of the areas that the disc inside the footprint may reach from the start.
std::vector<int> PathPlanner::areasFrom(const Pose2& start) const {
  const int own = coarse_clearance_.areaAt(start.position());
  if (own != 0 && isFree(start)) return {own};
  double longest = 0.0;
  for (const TablePattern& pattern : patterns_.patterns())
    longest = std::max(longest, pattern.end().pose.position().norm());
  return coarse_clearance_.areasNear(start.position(), config_.search.escape_patterns * longest);
}

/// Numbers of the areas in which the disc inside the footprint may be in the goal.
/** Cell by cell, because coarse cells are too optimistic for goals at walls, unless these are
 * large. */
std::vector<int> PathPlanner::areasAround(const Eigen::Vector2d& p_goal, double tolerance) const {
  const Grid& grid = checker_.grid();
  if (!(tolerance < kLargeGoal * grid.cellSize()))
    return coarse_clearance_.areasNear(p_goal, tolerance);
  const double corner = kMostSlack * grid.cellSize();
  const double reach = tolerance + corner;
  const Eigen::Vector2d lower = grid.centre(grid.lower());
  const Eigen::Vector2d upper =
      grid.centre({grid.lower().x + grid.width() - 1, grid.lower().y + grid.height() - 1});
  const auto cellAt = [&](const Eigen::Vector2d& p) {
    return grid.indexOf(p.cwiseMax(lower).cwiseMin(upper));
  };
  const CellIndex first = cellAt(p_goal - Eigen::Vector2d::Constant(reach));
  const CellIndex last = cellAt(p_goal + Eigen::Vector2d::Constant(reach));
  std::vector<int> areas;
  for (int y = first.y; y <= last.y; ++y) {
    for (int x = first.x; x <= last.x; ++x) {
      const Eigen::Vector2d p = grid.centre({x, y});
      if (checker_.field().quick(p.x(), p.y()) < inscribed_ - corner) continue;
      if ((p - p_goal).norm() > reach) continue;
      const int area = coarse_clearance_.areaAt(p);
      if (area != 0 && std::find(areas.begin(), areas.end(), area) == areas.end())
        areas.push_back(area);
    }
  }
  return areas;
}

/// Whether any pattern can be driven from the start, with a stop after it.
bool PathPlanner::anyBegins(const Pose2& start) const {
  const CollisionChecker& around = checker_;
  const bool is_free = isFree(start);
  const auto mayFollow = [&](const Pose2& from, const Overlap& overlap, const TablePattern& p) {
    if (is_free) return around.sweepFree(from, p, CollisionChecker::kBare);
    return config_.search.escape_patterns > 0 && around.escape(from, overlap, p).has_value();
  };
  const Overlap at_start = around.overlap(start);
  const auto& first = patterns_.from(patterns_.restClass());
  return std::any_of(first.begin(), first.end(), [&](const TablePattern* pattern) {
    if (!mayFollow(start, at_start, *pattern)) return false;
    if (pattern->exit == patterns_.restClass()) return true;
    const Pose2 end = start * pattern->end().pose;
    const Overlap at_end = around.overlap(end);
    const auto& stops = patterns_.stopsFrom(pattern->exit);
    return std::any_of(stops.begin(), stops.end(),
                       [&](const TablePattern* stop) { return mayFollow(end, at_end, *stop); });
  });
}

/// The disc inside the footprint finds no path although its area reaches the goal: nearly certain.
PathAnswer PathPlanner::answerWithoutWay(const PathQuery& query, const DistanceToGoal& way,
                                         const StopPredicate& stop, const PathEvents& events) {
  PathAnswer answer;
  answer.search.exhausted = true;
  answer.reason = way.problem();
  answer.closest =
      way.nearestWithinReach(query.T_map_start.position(), query.T_map_goal.position());
  if (!query.come_close || !answer.closest) return answer;
  PathAnswer close = comeClose(query, answer, stop, events);
  if (close.end == PathEnd::kUnreachable) close.end = PathEnd::kNoneInTime;
  return close;
}

PathAnswer PathPlanner::comeClose(const PathQuery& query, const PathAnswer& refusal,
                                  const StopPredicate& stop, const PathEvents& events) {
  PathQuery nearer = query;
  nearer.T_map_goal = {refusal.closest->x(), refusal.closest->y(), query.T_map_goal.yaw};
  nearer.yaw_tolerance = kPi;
  nearer.come_close = false;
  // The inscribed disc fits there; the vehicle may not be able to turn. A plan that ends anywhere
  // around is found soon; then closer ones are searched for, the last with all the remaining time.
  bool found = false;
  int before = 0;
  PathEvents noted = events;
  noted.better_plan = [&](double cost, int expansions) {
    found = true;
    if (events.better_plan) events.better_plan(cost, before + expansions);
  };
  // Possibly only a corner of the nearest coarse cell is free.
  const double corner = kMostSlack * (coarse_clearance_.coarseSize() + checker_.grid().cellSize());
  const double widest =
      std::max({query.position_tolerance, checker_.circumscribedRadius(), corner});
  PathAnswer answer;
  for (const double tolerance : {widest, widest / 2.0, query.position_tolerance}) {
    if (tolerance < query.position_tolerance) continue;
    const bool is_last = tolerance <= query.position_tolerance;
    nearer.position_tolerance = tolerance;
    found = false;
    PathAnswer next = this->answer(
        nearer, [&](int count) { return stop(before + count) || (found && !is_last); }, noted);
    const bool solved = next.end == PathEnd::kSolved;
    before += next.search.expansions;
    if (solved || answer.end != PathEnd::kSolved) answer = std::move(next);
    if (!solved || is_last || stop(before)) break;
    noted.search_begins = nullptr;
  }
  answer.search.expansions = before;
  answer.reason = answer.end == PathEnd::kSolved
                      ? "as close as possible: " + refusal.reason
                      : refusal.reason + "; coming close: " + answer.reason;
  answer.closest = refusal.closest;
  return answer;
}

}  // namespace tread::planner
