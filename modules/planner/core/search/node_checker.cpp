// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/search/node_checker.hpp"

#include <algorithm>

namespace tread::planner {

Uncertainty NodeChecker::uncertaintyAfter(const SearchNode& parent,
                                          const TablePattern& pattern) const {
  const Eigen::Vector2d step = pattern.end().pose.position();
  const auto x = static_cast<float>(step.x());
  const auto y = static_cast<float>(step.y());
  const float c = parent.cos_yaw;
  const float s = parent.sin_yaw;
  return compose(parent.uncertainty, pattern.uncertainty, c * x - s * y, s * x + c * y, c, s);
}

bool NodeChecker::admit(const SearchNode& parent, SearchNode& node) const {
  if (problem_->rules != nullptr) {
    node.level = 0;
    return node.cost < kNever;
  }
  return freeFromParent(parent, node) && canStop(node);
}

bool NodeChecker::freeFromParent(const SearchNode& parent, SearchNode& node) const {
  const CollisionChecker& around = *problem_->collision_checker;
  if (parent.level < 0) {
    if (parent.depth >= escape_patterns_) return false;
    const std::optional<Overlap> left = around.escape(parent.plainPose(), parent.overlap, *node.by);
    if (!left) return false;
    node.overlap = *left;
    node.uncertainty = uncertaintyAfter(parent, *node.by);
    node.level = static_cast<int8_t>(around.freeLevel(node.plainPose(), CollisionChecker::kPlan));
    return true;
  }
  node.uncertainty = uncertaintyAfter(parent, *node.by);
  const int wanted = onBranch(parent) ? CollisionChecker::kCheck : around.level(node.uncertainty);
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

}  // namespace tread::planner
