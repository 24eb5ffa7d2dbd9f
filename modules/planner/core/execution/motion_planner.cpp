// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/execution/motion_planner.hpp"

#include <algorithm>
#include <limits>
#include <utility>

namespace tread::planner {
namespace {

/// Distance of the vehicle from the window's middle at which it is extracted again [m].
constexpr double kWindowSlack = 2.0;
/// Least extent of the distance field around the vehicle [m].
constexpr double kFieldSlack = 5.0;
/// Tolerance by which the distance field may pass closer to fences than allowed [m].
constexpr double kFenceNear = 0.3;
/// Distance along the path to the goal within which the narrowest place is searched [m].
constexpr double kDetourLook = 3.0;
constexpr double kDetourStep = 0.2;
/// Least distance of a detour from the vehicle [m].
constexpr double kDetourNear = 0.8;

std::vector<int> idsOf(const std::vector<PlanStep>& plan) {
  std::vector<int> ids;
  for (const PlanStep& step : plan) ids.push_back(step.pattern_id);
  return ids;
}

/// Whether a plan ends in the goal or far enough ahead; another one may end in a dead end.
bool leadsOn(SearchEnd end) {
  return end == SearchEnd::kGoal || end == SearchEnd::kHorizon;
}

bool isCutOff(const SearchResult& result) {
  return result.end == SearchEnd::kProgress;
}

}  // namespace

bool PlanningMap::put(Tile tile, double cell_size, int tile_cells) {
  if (!(cell_size > 0.0) || tile_cells <= 0) return false;
  if (tile.cells.size() != static_cast<size_t>(tile_cells) * static_cast<size_t>(tile_cells))
    return false;
  if (!map_ || map_->cellSize() != cell_size || map_->tileCells() != tile_cells) {
    map_.emplace(cell_size, tile_cells, config_.clearance);
    window_revision_ = field_revision_ = -1;
  }
  map_->put(std::move(tile));
  return true;
}

void PlanningMap::assumeFreeUnder(const Pose2& T_map_body) {
  const Footprint bare(config_.footprint, 0.0);
  map_->assumeFree(bare.cells(Grid(map_->cellSize(), {}, 0, 0), T_map_body));
}

void PlanningMap::setPositionStd(double std) {
  constexpr double kStep = 0.05;  // [m] smaller changes do not justify another check of the map
  const double wanted = positionMargin(std);
  if (wanted <= position_growth_ && wanted > position_growth_ - 2.0 * kStep) return;
  position_growth_ = kStep * std::ceil(wanted / kStep);
  fenced_changed_ = true;
}

void PlanningMap::setSlowness(const std::array<float, kCostMax + 1>& slowness) {
  // Of itself: smaller changes do not justify a new distance to the goal
  constexpr float kSame = 0.1F;
  std::vector<float>& used = config_.field.slowness;
  const auto same = [](float a, float b) { return std::abs(a - b) <= kSame * b; };
  if (std::equal(slowness.begin(), slowness.end(), used.begin(), used.end(), same)) return;
  used.assign(slowness.begin(), slowness.end());
  weights_changed_ = true;
}

void PlanningMap::setStoppingTime(double seconds) {
  constexpr double kNoticeable = 0.05;  // [s]
  const double wanted = std::max(seconds, 0.5 * config_.stopping_time);
  if (std::abs(wanted - stopping_time_) < kNoticeable) return;
  stopping_time_ = wanted;
  fenced_changed_ = true;
}

void PlanningMap::keepOut(const Fence& found) {
  constexpr size_t kMostFound = 32;
  if (found_.size() >= kMostFound) found_.erase(found_.begin());
  found_.push_back(found);
  fenced_changed_ = true;
}

void PlanningMap::fenceIn() {
  if (!fenced_changed_) return;
  fenced_changed_ = false;
  if (fences_.empty() && found_.empty() && fenced_.empty()) return;
  std::vector<Fence> all = fences_;
  all.insert(all.end(), found_.begin(), found_.end());
  fenced_ = FencedGround(std::move(all), config_.full_speed * stopping_time_ + position_growth_);
  window_revision_ = field_revision_ = -1;
}

std::string PlanningMap::whyFenced(const Goal& goal) const {
  const FenceRoom room = fenced_.room(goal.T_map_goal.position());
  const double needed = fenced_.growth() + config_.footprint.half_width - goal.position_tolerance;
  if (fenced_.empty() || room.metres >= needed) return "";
  if (room.metres < 0.0) return "the goal lies outside of what fence " + room.nearest + " allows";
  return "the goal is " + withTenths(room.metres) + " m from fence " + room.nearest + ": " +
         withTenths(needed) + " m are needed to stop before it";
}

void PlanningMap::updateCollisionChecker(const Pose2& T_map_body, int64_t now) {
  assumeFreeUnder(T_map_body);
  fenceIn();
  const Eigen::Vector2d p = T_map_body.position();
  const bool moved = (p - p_window_).norm() > kWindowSlack;
  const bool due = window_revision_ < 0 || now - window_time_ >= config_.window_period;
  const bool changed = window_revision_ != map_->revision() && due;
  if (checker_ && !changed && !moved) return;
  window_time_ = now;
  map_->forgetBeyond(p);
  const double cell = map_->cellSize();
  const int cells = static_cast<int>(std::ceil(config_.window / cell));
  const CellIndex lower{static_cast<int>(std::floor(p.x() / cell)) - cells / 2,
                        static_cast<int>(std::floor(p.y() / cell)) - cells / 2};
  Grid window = map_->window(lower, cells, cells);
  constexpr double kReach = 5.0;  // [m]
  if (!config_.field.slowness.empty()) spreadRoughness(window, kReach);
  checker_.emplace(std::move(window), config_.footprint, config_.margins, config_.unknown_blocks,
                   fenced_);
  window_revision_ = map_->revision();
  p_window_ = p;
}

bool PlanningMap::sameGoal(const Goal& goal) const {
  const Pose2& a = goal.T_map_goal;
  return field_goal_ && field_goal_->id == goal.id && field_goal_->T_map_goal.x == a.x &&
         field_goal_->T_map_goal.y == a.y && field_goal_->T_map_goal.yaw == a.yaw &&
         field_goal_->position_tolerance == goal.position_tolerance &&
         field_goal_->yaw_tolerance == goal.yaw_tolerance;
}

void PlanningMap::updateDistance(const Pose2& T_map_body, const Goal& goal, int64_t now) {
  if (field_goal_ && field_goal_->id != goal.id) forgetDetours();
  const Eigen::Vector2d p = T_map_body.position();
  const bool same = sameGoal(goal);
  // Beyond a fence, or much too close to it, the only path is back, which the search handles.
  const bool fenced =
      !fenced_.empty() &&
      fenced_.room(p).metres >= fenced_.growth() + config_.field.inflation - kFenceNear;
  const bool covered = same && fenced == field_fenced_ &&
                       distance_to_goal_.covers(p, kFieldSlack) &&
                       (p - p_field_).norm() < kFieldSlack;
  if (covered && field_revision_ >= 0 && now - field_time_ < config_.field_period) return;
  map_->refresh();
  field_time_ = now;
  if (covered && field_revision_ == map_->clearanceRevision() && !weights_changed_) return;
  field_fenced_ = fenced;
  fenced_goal_ = whyFenced(goal);
  computeDistance(goal, p);
  field_goal_ = goal;
  field_revision_ = map_->clearanceRevision();
  p_field_ = p;
  weights_changed_ = false;
  std::optional<Eigen::Vector2d> before;
  if (same && !goal_substitution_reason_.empty()) before = target_.T_map_goal.position();
  target_ = goal;
  goal_substitution_reason_.clear();
  goal_enclosed_ = false;
  if (config_.come_close && distance_to_goal_.unreachable()) substituteGoal(p, before);
}

void PlanningMap::substituteGoal(const Eigen::Vector2d& p_vehicle,
                                 const std::optional<Eigen::Vector2d>& before) {
  const Eigen::Vector2d p_goal = target_.T_map_goal.position();
  const std::optional<Eigen::Vector2d> nearest =
      distance_to_goal_.nearestWithinReach(p_vehicle, p_goal, before);
  if (!nearest) return;
  goal_enclosed_ = distance_to_goal_.enclosed();
  goal_substitution_reason_ = "as close as possible, " + withTenths((*nearest - p_goal).norm()) +
                              " m: " + distance_to_goal_.problem();
  target_.T_map_goal = {nearest->x(), nearest->y(), target_.T_map_goal.yaw};
  target_.yaw_tolerance = kPi;
  // Half the width is free there, but the vehicle may not fit in every heading.
  const double arm = checker_->circumscribedRadius() + config_.margins.plan;
  target_.position_tolerance = std::max(target_.position_tolerance, arm);
  computeDistance(target_, p_vehicle);
}

void PlanningMap::computeDistance(const Goal& goal, const Eigen::Vector2d& p_vehicle) {
  const FencedClearance fenced(*map_, field_fenced_ ? fenced_ : no_fences_);
  // There is no path where no search may go. The middle of a gap may be half a cell beside a cell's
  // centre.
  DistanceFieldConfig field = config_.field;
  field.inflation += std::max(0.0, config_.margins.least() - map_->cellSize() / 2.0);
  distance_to_goal_.compute(fenced, goal, p_vehicle, detours_, field);
}

void PlanningMap::addDetour(const Eigen::Vector2d& p_map) {
  detours_.push_back({p_map, 0.7});
  weights_changed_ = true;
}

void PlanningMap::addDetourAhead(const Eigen::Vector2d& p_vehicle, int most) {
  if (static_cast<int>(detours_.size()) >= most) return forgetDetours();
  std::optional<Eigen::Vector2d> narrowest;
  double least = std::numeric_limits<double>::infinity();
  const int points = static_cast<int>(kDetourLook / kDetourStep);
  for (const Eigen::Vector2d& at : distance_to_goal_.descend(p_vehicle, kDetourStep, points)) {
    const double clearance = checker_->clearance(at);
    if ((at - p_vehicle).norm() < kDetourNear || clearance >= least) continue;
    least = clearance;
    narrowest = at;
  }
  if (narrowest) addDetour(*narrowest);
}

void PlanningMap::forgetDetours() {
  weights_changed_ = weights_changed_ || !detours_.empty();
  detours_.clear();
}

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
  // A plan that was cut off ends anywhere: only its remaining distance to the goal can be compared.
  if (isCutOff(fresh)) return fresh.expected + config_.gain < along_branch.expected;
  return fresh.cost + fresh.expected + config_.gain < along_branch.cost + along_branch.expected;
}

PlannedWay MotionPlanner::plan(const PlanRequest& request, int expansions, Counters& counters) {
  PlannedWay way{search(request, expansions, counters), {}};
  way.risk = riskOf(
      {request.map.collisionChecker(), *request.table, request.start, way.steps, request.reaction});
  return way;
}

SearchResult MotionPlanner::search(const PlanRequest& request, int expansions, Counters& counters) {
  SearchProblem problem;
  problem.T_map_start = request.start.T_map_end;
  problem.start_class = request.start.exit_class;
  problem.start_uncertainty = request.start.uncertainty;
  problem.patterns = request.table.get();
  problem.collision_checker = &request.map.collisionChecker();
  problem.distance_to_goal = &request.map.distanceToGoal();
  problem.ground = request.ground;
  problem.goal = request.map.target();
  problem.deceleration = request.deceleration;
  for (const PlanStep& step : request.last_steps) problem.committed.push_back(step.pattern_id);
  if (searched_table_ != request.table)
    counters["cycles driven until a plan with the newest set"] = cycles_with_old_set_;
  searched_table_ = request.table;
  // A stop condition counts all expansions of a step, so that a replay stops at the same one.
  int before = 0;
  bool late = false;
  const StopPredicate enough = [&](int count) {
    late = late || (stop_ && stop_(before + count));
    return late || count >= expansions;
  };
  SearchResult result = search_.run(problem, enough);
  before = result.expansions;
  if (!late && leadsOn(request.last_end) && !problem.committed.empty())
    result = keepPlan(problem, std::move(result), enough, counters);
  before = result.expansions;
  if (!late && !leadsOn(result.end))
    result = withLittleRoom(problem, std::move(result), enough, counters);
  before = result.expansions;
  if (!late && result.end != SearchEnd::kNothing)
    result = keepSide(problem, std::move(result), enough, counters);
  else if (!late && request.may_keep_next)
    result = keepNext(problem, std::move(result), enough, counters);
  ++counters["plans"];
  counters["expansions"] += result.expansions;
  return result;
}

/// The best plan along problem.branch; both results include the expansions of both.
SearchResult MotionPlanner::alongBranch(const SearchProblem& problem, const StopPredicate& stop,
                                        SearchResult& fresh) {
  SearchResult along = branch_search_.run(problem, stop);
  fresh.expansions += along.expansions;
  along.expansions = fresh.expansions;
  return along;
}

/// The fresh plan, or the last one if that still leads on and does not cost more.
/** A search takes the first plan that it finds: the next one may be as long, but begin differently.
 * A vehicle that always follows the newest oscillates in tight places. And a plan that backs out
 * of a dead end is found at its end; after backing a little, the search is cut off earlier, and
 * its partial result leads back in. */
SearchResult MotionPlanner::keepPlan(SearchProblem& problem, SearchResult fresh,
                                     const StopPredicate& stop, Counters& counters) {
  const bool found = leadsOn(fresh.end);
  if (found && (fresh.steps.empty() || fresh.steps.front().pattern_id == problem.committed.front()))
    return fresh;
  problem.branch = problem.committed;
  problem.branch_is_plan = true;
  SearchResult along = alongBranch(problem, stop, fresh);
  problem.branch.clear();
  problem.branch_is_plan = false;
  if (!leadsOn(along.end)) return fresh;
  if (found && fresh.cost + fresh.expected < along.cost + along.expected) return fresh;
  ++counters["kept to its plan"];
  std::swap(search_, branch_search_);
  return along;
}

/// If no plan with the full margin leads on, one with the least margin.
SearchResult MotionPlanner::withLittleRoom(SearchProblem& problem, SearchResult fresh,
                                           const StopPredicate& stop, Counters& counters) {
  if (problem.collision_checker->margins().narrow <= 0.0) return fresh;
  problem.little_room = true;
  SearchResult narrow = alongBranch(problem, stop, fresh);
  const bool better =
      fresh.end == SearchEnd::kNothing ? narrow.end != SearchEnd::kNothing : leadsOn(narrow.end);
  if (!better) {
    problem.little_room = false;
    return fresh;
  }
  ++counters["plans with little room"];
  std::swap(search_, branch_search_);
  return narrow;
}

/// The fresh plan, or the best along the branch if the fresh one turns to the other side and is not
/// better enough.
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
