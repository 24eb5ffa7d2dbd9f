// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/search/search_problem.hpp"

#include <algorithm>
#include <cmath>

namespace tread::planner {
namespace {

/// Closer to the goal its heading counts, farther away that of the path [m].
constexpr double kNearGoal = 1.0;
/// Step of the check of a slide to a stop, and distances too short to check [m].
constexpr double kSlideStep = 0.1;
/// Factor where the heuristic has no path: it may be wrong, but rarely [1].
constexpr float kUnlikely = 100.0F;

/// Arc cosine to within 7e-5 rad (Abramowitz and Stegun 1964, 4.4.45), clamped.
float arcCosine(float x) {
  const float a = std::min(1.0F, std::abs(x));
  const float value =
      std::sqrt(1.0F - a) * (1.5707288F + a * (-0.2121144F + a * (0.0742610F - 0.0187293F * a)));
  return x < 0.0F ? static_cast<float>(kPi) - value : value;
}

/// [m] straight-line distance.
float distanceTo(const Goal& goal, const SearchNode& node) {
  const double dx = goal.T_map_goal.x - node.x;
  const double dy = goal.T_map_goal.y - node.y;
  return static_cast<float>(std::sqrt(dx * dx + dy * dy));
}

}  // namespace

CostModel::CostModel(const SearchConfig& config, const SearchProblem& problem)
    : config_(config), problem_(&problem) {
  const PatternTable& patterns = *problem.patterns;
  speed_ = patterns.bestSpeed();
  goal_yaw_ = static_cast<float>(wrapAngle(problem.goal.T_map_goal.yaw));
  yaw_tolerance_ = static_cast<float>(problem.goal.yaw_tolerance);
  for (size_t i = 0; i < 2; ++i) {
    metre_cost_[i] = static_cast<float>(patterns.leastCosts()[i].per_metre);
    radian_cost_[i] = static_cast<float>(patterns.leastCosts()[i].per_radian);
  }
  distance_share_ = static_cast<float>(config.distance_share);
  aimed_ = static_cast<float>(config.goal_share * problem.goal.position_tolerance);
  to_rest_ = costsToRest();
  if (problem.distance_to_goal == nullptr) return;
  slack_ = static_cast<float>(problem.distance_to_goal->cellSlack());
  admissible_share_ = static_cast<float>(DistanceToGoal::kAdmissibleShare);
}

std::vector<float> CostModel::costsToRest() const {
  const PatternTable& patterns = *problem_->patterns;
  std::vector<float> costs(static_cast<size_t>(patterns.classCount()), 0.0F);
  for (int i = 0; i < patterns.classCount(); ++i) {
    const auto& stops = patterns.stopsFrom(i);
    if (i == patterns.restClass() || stops.empty()) continue;
    const auto quickest = std::min_element(
        stops.begin(), stops.end(),
        [](const TablePattern* a, const TablePattern* b) { return a->cost < b->cost; });
    costs[static_cast<size_t>(i)] = static_cast<float>((*quickest)->cost + config_.stop_penalty);
  }
  return costs;
}

float CostModel::edgeCost(const SearchNode& parent, const TablePattern& pattern,
                          const SearchNode& end) const {
  if (problem_->rules != nullptr) return problem_->rules->cost(parent.x, parent.y, pattern);
  double weight = 1.0;
  const CollisionChecker& around = *problem_->collision_checker;
  if (config_.near_penalty > 0.0)
    weight += config_.near_penalty * around.nearness(end.x, end.y, config_.near_distance);
  if (pattern.reverses) weight += config_.reverse_penalty;
  double cost = pattern.cost * weight;
  if (problem_->ground != nullptr)
    cost += problem_->ground->cost(around.grid(), parent.pose(), pattern);
  const int rest = problem_->patterns->restClass();
  if (pattern.exit == rest && pattern.entry != rest) cost += config_.stop_penalty;
  return static_cast<float>(cost);
}

bool CostModel::staysOnPlan(const SearchNode& parent, const TablePattern& pattern) const {
  const auto depth = static_cast<size_t>(parent.depth);
  return parent.on_plan == parent.depth && depth < problem_->committed.size() &&
         problem_->committed[depth] == pattern.id();
}

float CostModel::switchPenalty(const SearchNode& parent, const TablePattern& pattern) const {
  const auto depth = static_cast<size_t>(parent.depth);
  if (parent.on_plan != parent.depth || depth >= problem_->committed.size()) return 0.0F;
  if (problem_->committed[depth] == pattern.id()) return 0.0F;
  return static_cast<float>(config_.switch_penalty * std::exp2(-parent.depth));
}

/// There is no path over blocked ground; a vehicle that leaves it may head straight for the goal.
CostModel::Heuristic CostModel::heuristic(const SearchNode& node, bool on_blocked_ground) const {
  const Goal& goal = problem_->goal;
  DistanceToGoal::Sample at;
  if (problem_->distance_to_goal != nullptr) {
    at = problem_->distance_to_goal->sample(node.x, node.y);
    if (!(at.length < kNever) && !on_blocked_ground) return {kNever, kNever};
  }
  if (problem_->distance_to_goal == nullptr || !(at.length < kNever)) {
    const auto tolerance = static_cast<float>(goal.position_tolerance);
    at.length = std::max(0.0F, distanceTo(goal, node) - tolerance);
  }
  float off_goal = 0.0F;
  if (goal.yaw_tolerance < kPi)
    off_goal = std::max(0.0F, std::abs(wrapped(node.yaw - goal_yaw_)) - yaw_tolerance_);
  float way = std::max(0.0F, admissible_share_ * at.length - slack_);
  float expected_way = std::max(0.0F, distance_share_ * at.length - slack_);
  if (at.length < kNearGoal) {
    // The distance ends at the edge of the goal's tolerance; the target is inside of it.
    const float straight = distanceTo(goal, node) - aimed_;
    way = std::max(way, straight);
    expected_way = std::max(expected_way, straight);
  }
  const float bound = std::max(metre_cost_[0] * way + radian_cost_[0] * off_goal,
                               metre_cost_[1] * way + radian_cost_[1] * off_goal);
  if (problem_->heading_heuristic != nullptr) {
    const float known = problem_->heading_heuristic->at(node.x, node.y, node.yaw);
    return {bound,
            weights_.heuristic * std::max(bound, std::min(known, kUnlikely * (1.0F + bound)))};
  }
  float turn = off_goal;
  if (weights_.turn > 0.0F && at.length > kNearGoal)
    turn = arcCosine(at.along_x * node.cos_yaw + at.along_y * node.sin_yaw);
  const float expected = std::max(bound, metre_cost_[0] * expected_way);
  return {bound, weights_.heuristic * expected + weights_.turn * radian_cost_[1] * turn};
}

int NodeChecker::levelOf(const SearchNode& parent, const TablePattern& pattern) const {
  const CollisionChecker& around = *problem_->collision_checker;
  const bool on_branch = onBranch(parent);
  if (on_branch && !problem_->branch_is_plan) return CollisionChecker::kCheck;
  const bool little = problem_->little_room || (on_branch && around.margins().narrow > 0.0);
  const auto level = [&](const Uncertainty& uncertainty) {
    return little ? around.leastLevel(uncertainty) : around.level(uncertainty);
  };
  if (parent.depth > 0) return level(pattern.uncertainty);
  const Eigen::Vector2d step = pattern.end().pose.position();
  const auto x = static_cast<float>(step.x());
  const auto y = static_cast<float>(step.y());
  const float c = parent.cos_yaw;
  const float s = parent.sin_yaw;
  return level(compose(problem_->start_uncertainty, pattern.uncertainty, c * x - s * y,
                       s * x + c * y, c, s));
}

bool NodeChecker::admit(const SearchNode& parent, SearchNode& node) const {
  if (problem_->rules != nullptr) {
    node.level = 0;
    return node.cost < kNever;
  }
  return freeFromParent(parent, node) && canStop(node) && slidesFreely(node);
}

bool NodeChecker::freeFromParent(const SearchNode& parent, SearchNode& node) const {
  const CollisionChecker& around = *problem_->collision_checker;
  if (parent.level < 0) {
    // The path back over a fence may be long.
    if (parent.depth >= escape_patterns_ && parent.overlap.fenced <= 0.0F) return false;
    const std::optional<Overlap> left = around.escape(parent.plainPose(), parent.overlap, *node.by);
    if (!left) return false;
    node.overlap = *left;
    node.level = static_cast<int8_t>(around.freeLevel(node.plainPose(), CollisionChecker::kPlan));
    return true;
  }
  const int wanted = levelOf(parent, *node.by);
  if (around.sweepFree(parent.pose(), *node.by, wanted)) {
    node.level = static_cast<int8_t>(wanted);
    return true;
  }
  if (parent.level >= wanted) return false;
  if (!around.sweepRegains(parent.pose(), parent.level, *node.by, wanted)) return false;
  node.level = static_cast<int8_t>(around.freeLevel(node.plainPose(), wanted));
  return true;
}

bool NodeChecker::canStop(const SearchNode& node) const {
  if (node.motion_class == problem_->patterns->restClass()) return true;
  const CollisionChecker& around = *problem_->collision_checker;
  const auto& stops = problem_->patterns->stopsFrom(node.motion_class);
  return std::any_of(stops.begin(), stops.end(), [&](const TablePattern* stop) {
    return node.level < 0 ? around.escape(node.plainPose(), node.overlap, *stop).has_value()
                          : around.sweepFree(node.pose(), *stop, node.level);
  });
}

bool NodeChecker::slidesFreely(const SearchNode& node) const {
  if (!(problem_->deceleration < kNoLimit) || node.level < 0) return true;
  const double speed = node.by->v_exit.norm();
  const double way = speed * speed / (2.0 * problem_->deceleration);
  if (way < kSlideStep) return true;
  const CollisionChecker& around = *problem_->collision_checker;
  const int level = std::min<int>(node.level, CollisionChecker::kCheck);
  const Eigen::Vector2d along = node.by->v_exit / speed;
  TurnedPose at = node.pose();
  const double dx = at.cos_yaw * along.x() - at.sin_yaw * along.y();
  const double dy = at.sin_yaw * along.x() + at.cos_yaw * along.y();
  for (double done = 0.0; done < way; done += kSlideStep) {
    const double s = std::min(way, done + kSlideStep);
    at.x = node.x + s * dx;
    at.y = node.y + s * dy;
    if (!around.isFree(at, level)) return false;
  }
  return true;
}

}  // namespace tread::planner
