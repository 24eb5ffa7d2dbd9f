// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/plan/task_planner.hpp"

#include <sys/resource.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <stdexcept>

#include "common/config/scalars.hpp"

namespace tread::plan {
namespace {

using Clock = std::chrono::steady_clock;

/// A point still needs an outline: far smaller than a cell.
constexpr double kPoint = 1e-3;  // [m]
constexpr size_t kDrawnNodes = 60'000;

/// Takes the time of one query [ms].
struct Watch {
  /// `spent` of the deadline is over already.
  explicit Watch(std::optional<double> until = std::nullopt, double spent = 0.0) : deadline(until) {
    if (deadline) deadline = std::max(0.0, *deadline - spent);
  }

  double now() const {
    return std::chrono::duration<double, std::milli>(Clock::now() - begin).count();
  }
  /// A little before the deadline: the rest is needed to put the answer together.
  bool isLate() const { return deadline && now() >= *deadline - std::min(2.0, *deadline / 20); }

  Clock::time_point begin = Clock::now();
  std::optional<double> deadline;
  std::optional<double> searching;  ///< when the heuristics were computed
  std::optional<double> first;      ///< when the first plan was there
};

double peakMegabytes() {
  rusage usage{};
  getrusage(RUSAGE_SELF, &usage);
  return static_cast<double>(usage.ru_maxrss) / 1024.0;
}

FootprintSize footprintOf(const RobotShape& shape) {
  const double length = shape.isRectangle() ? shape.length : kPoint;
  const double width = shape.isRectangle() ? shape.width : kPoint;
  return {length / 2.0, length / 2.0, width / 2.0};
}

/// How finely sweeps are checked: a point must not jump over a cell.
planner::SweepResolution sweepResolution(const PlanTask& task) {
  planner::SweepResolution step;
  if (task.shape.isRectangle()) return planner::resolutionFor(footprintOf(task.shape), 0.0, step);
  step.distance = step.covered = std::min(step.distance, task.grid.cellSize() / 2);
  step.outline = footprintOf(task.shape);
  return step;
}

}  // namespace

TaskPlanner::TaskPlanner(const PlanTask& task) : task_(task) {
  const Watch watch;
  if (task.exact)
    prepareLattice();
  else
    preparePlanner();
  preparation_ms_ = watch.now();
}

void TaskPlanner::prepareLattice() {
  primitives_ = onLattice(*task_.primitives, task_.pace);
  const CostThresholds& thresholds = task_.map.thresholds;
  const CellCosts costs(task_.grid.width(), task_.grid.height(), task_.map.costs,
                        std::min(thresholds.obstacle, thresholds.inscribed));
  lattice_ = std::make_unique<LatticePlanner>(costs, task_.grid.cellSize(),
                                              static_cast<int>(task_.primitives->headings.size()),
                                              primitives_);
}

void TaskPlanner::preparePlanner() {
  if (task_.patterns) {
    patterns_ = std::make_unique<planner::PatternTable>(*task_.patterns, sweepResolution(task_),
                                                        planner::DefaultSigma{});
    if (const std::string defect = patterns_->defect(); !defect.empty())
      throw std::runtime_error("--patterns: " + defect);
  } else {
    primitives_ = headingFree(*task_.primitives, task_.pace);
    patterns_ = std::make_unique<planner::PatternTable>(
        std::vector<planner::Primitive>{primitives_.begin(), primitives_.end()},
        sweepResolution(task_));
  }
  planner::PathConfig config;
  config.footprint = footprintOf(task_.shape);
  if (!task_.shape.isRectangle()) config.grown = task_.shape.radius;
  planner_ = std::make_unique<planner::PathPlanner>(task_.grid, *patterns_, config);
}

PlanAnswer TaskPlanner::answer(const PlanQuery& query, double spent_ms) {
  Watch watch(task_.deadline_ms, spent_ms);
  planner::PathQuery wanted;
  wanted.T_map_start = between(task_.map.T_map_grid, query.T_map_start);
  wanted.T_map_goal = between(task_.map.T_map_grid, query.T_map_goal);
  wanted.position_tolerance = task_.position_tolerance;
  wanted.yaw_tolerance = task_.yaw_tolerance;
  wanted.come_close = task_.come_close;
  const planner::PathEvents events{
      [&watch] { watch.searching = watch.now(); },
      [&watch](double, int) { watch.first = watch.first.value_or(watch.now()); }};
  const auto stop = [&watch](int) { return watch.isLate(); };
  const planner::PathAnswer found =
      task_.exact ? lattice_->answer(wanted, stop, events) : planner_->answer(wanted, stop, events);
  PlanAnswer answer;
  answer.total_ms = watch.now();
  answer.first_solution_ms = watch.first;
  if (!task_.exact) answer.heuristic_ms = watch.searching.value_or(0.0);
  answer.expansions = found.search.expansions;
  answer.end = found.end;
  answer.all_seen = found.search.exhausted;
  answer.reason = found.reason;
  tellPlan(wanted.T_map_start, found.search, answer);
  if (answer.end != planner::PathEnd::kSolved || found.closest)
    answer.closest = closestApproach(found, query, answer);
  answer.memory_mb = peakMegabytes();
  return answer;
}

std::string TaskPlanner::nameOf(int number) const {
  if (!task_.patterns) return std::to_string(primitives_[static_cast<size_t>(number)].file_id);
  const MotionPattern* pattern = task_.patterns->find(number);
  return pattern == nullptr ? std::to_string(number) : pattern->name;
}

void TaskPlanner::tellPlan(const Pose2& T_grid_start, const planner::SearchResult& result,
                           PlanAnswer& answer) const {
  if (result.steps.empty()) return;
  const auto tell = [&](const Pose2& T_grid_body) {
    Pose2 pose = task_.map.T_map_grid * T_grid_body;
    pose.yaw = wrapAngle(pose.yaw);
    answer.poses.push_back(pose);
  };
  Pose2 T_grid_begin = T_grid_start;
  tell(T_grid_begin);
  for (const planner::PlanStep& step : result.steps) {
    const planner::TablePattern& pattern = *patterns().find(step.pattern_id);
    for (const planner::SweptPose& at : pattern.swept_poses) tell(T_grid_begin * at.pose);
    T_grid_begin = step.T_map_end;
    answer.ends.push_back(answer.poses.size() - 1);
    answer.patterns.push_back(nameOf(step.pattern_id));
    answer.length += pattern.length;
  }
  answer.time = result.steps.back().time;
  answer.cost = result.cost;
}

ClosestApproach TaskPlanner::closestApproach(const planner::PathAnswer& found,
                                             const PlanQuery& query,
                                             const PlanAnswer& answer) const {
  Eigen::Vector2d p_map = query.T_map_start.position();
  if (found.closest) {
    p_map = task_.map.T_map_grid * *found.closest;
  } else if (!answer.poses.empty()) {
    p_map = answer.poses.back().position();
  }
  return {p_map, (p_map - query.T_map_goal.position()).norm()};
}

PlanScene TaskPlanner::scene(const PlanQuery& query, const PlanAnswer& answer) const {
  PlanScene scene;
  scene.grid = task_.shape.isPoint() ? task_.grid : gridForFootprint(task_.map);
  scene.T_map_grid = task_.map.T_map_grid;
  const std::vector<planner::TreeNode> tree = search().tree(kDrawnNodes);
  for (const planner::TreeNode& node : tree) {
    if (node.parent < 0) continue;
    const Pose2 T_map_begin =
        task_.map.T_map_grid * tree[static_cast<size_t>(node.parent)].T_map_body;
    scene.tree.push_back({T_map_begin.position()});
    for (const planner::SweptPose& at : patterns().find(node.pattern_id)->swept_poses)
      scene.tree.back().push_back(T_map_begin * at.pose.position());
  }
  for (const Pose2& pose : answer.poses) scene.path.push_back(pose.position());
  if (!answer.poses.empty()) scene.stations.push_back(answer.poses.front());
  for (const size_t end : answer.ends) scene.stations.push_back(answer.poses[end]);
  if (task_.shape.isRectangle()) scene.outline = rectangle(task_.shape.length, task_.shape.width);
  scene.radius = task_.shape.radius;
  scene.T_map_start = query.T_map_start;
  scene.T_map_goal = query.T_map_goal;
  return scene;
}

}  // namespace tread::plan
