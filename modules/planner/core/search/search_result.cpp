// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>

#include "modules/planner/core/search/pattern_search.hpp"

namespace tread::planner {

PlanStep stepAfter(const PlanStep& before, const TablePattern& pattern) {
  PlanStep step;
  step.pattern_id = pattern.id();
  step.T_map_end = before.T_map_end * pattern.end().pose;
  step.exit_class = pattern.exit;
  step.time = before.time + pattern.duration;
  const double yaw = before.T_map_end.yaw;
  step.uncertainty = compose(before.uncertainty, pattern.uncertainty,
                             static_cast<float>(step.T_map_end.x - before.T_map_end.x),
                             static_cast<float>(step.T_map_end.y - before.T_map_end.y),
                             static_cast<float>(std::cos(yaw)), static_cast<float>(std::sin(yaw)));
  return step;
}

SearchResult PatternSearch::finish(int leaf, SearchEnd end) {
  SearchResult result;
  result.expansions = expansions_;
  if (leaf < 0) {
    result.reason = expansions_ <= 1 ? "no pattern is free from here"
                                     : "no free sequence of patterns brings the goal nearer";
    return result;
  }
  result.end = end;
  for (int i = leaf; i >= 0; i = nodes_[static_cast<size_t>(i)].parent) leaf_to_root_.push_back(i);
  // Nodes are kept in single precision in part: the plan's poses are composed anew.
  PlanStep step;
  step.T_map_end = problem_->T_map_start;
  step.uncertainty = problem_->start_uncertainty;
  for (auto it = leaf_to_root_.rbegin() + 1; it != leaf_to_root_.rend(); ++it) {
    const Node& node = nodes_[static_cast<size_t>(*it)];
    for (int i = 0; i < node.repeats; ++i) {
      step = stepAfter(step, *node.by);
      result.steps.push_back(step);
    }
  }
  const Node& last = nodes_[static_cast<size_t>(leaf)];
  result.cost = static_cast<double>(last.cost);
  result.expected = static_cast<double>(last.inflated);
  const bool any_field = problem_->distance_to_goal != nullptr;
  result.way_to_go =
      any_field ? problem_->distance_to_goal->length({last.x, last.y})
                : (problem_->goal.T_map_goal.position() - Eigen::Vector2d(last.x, last.y)).norm();
  result.time_to_go = static_cast<double>(last.time) + result.way_to_go / speed_;
  return result;
}

std::vector<TreeNode> PatternSearch::tree(size_t count) const {
  std::vector<int> order;  // of the nodes that were expanded in the last search
  for (size_t i = kept_; i < nodes_.size(); ++i)
    if (nodes_[i].expanded()) order.push_back(static_cast<int>(i));
  const auto earlier = [this](int a, int b) {
    return nodes_[static_cast<size_t>(a)].number < nodes_[static_cast<size_t>(b)].number;
  };
  std::sort(order.begin(), order.end(), earlier);
  std::vector<int> wanted(leaf_to_root_.rbegin(), leaf_to_root_.rend());
  std::vector<bool> chosen(nodes_.size(), false);
  for (const int i : wanted) chosen[static_cast<size_t>(i)] = true;
  for (const int i : order)
    if (!chosen[static_cast<size_t>(i)] && wanted.size() < count) wanted.push_back(i);
  // Parents are expanded before their children; the plan of an earlier search comes first.
  std::sort(wanted.begin(), wanted.end(), [&](int a, int b) {
    const bool kept_a = static_cast<size_t>(a) < kept_;
    const bool kept_b = static_cast<size_t>(b) < kept_;
    if (kept_a || kept_b) return kept_a && kept_b ? a < b : kept_a;
    return earlier(a, b);
  });
  return drawn(wanted);
}

std::vector<TreeNode> PatternSearch::drawn(const std::vector<int>& wanted) const {
  std::vector<int> index(nodes_.size(), -1);
  std::vector<TreeNode> drawn;
  for (const int i : wanted) {
    const Node& node = nodes_[static_cast<size_t>(i)];
    index[static_cast<size_t>(i)] = static_cast<int>(drawn.size());
    drawn.push_back({node.parent < 0 ? -1 : index[static_cast<size_t>(node.parent)],
                     node.by == nullptr ? -1 : node.by->id(), node.plainPose(),
                     static_cast<double>(node.time)});
  }
  branch_.clear();
  for (auto it = leaf_to_root_.rbegin(); it != leaf_to_root_.rend(); ++it)
    branch_.push_back(index[static_cast<size_t>(*it)]);
  return drawn;
}

size_t PatternSearch::bytes() const {
  return nodes_.bytes() + best_.bytes() + open_.bytes();
}

}  // namespace tread::planner
