// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// A search begins, is begun again with other weights, and ends.
#include <algorithm>
#include <cmath>

#include "modules/planner/core/search/pattern_search.hpp"

namespace tread::planner {
namespace {

/// Share of the cost that counts against a leaf when the search is cut off.
constexpr float kLeafCost = 0.25F;

}  // namespace

SearchResult PatternSearch::run(const SearchProblem& problem, const StopPredicate& stop) {
  begin(problem);
  RunEnd end = RunEnd::kBetterPlan;
  for (int number = 0; number <= config_.improvements && end == RunEnd::kBetterPlan; ++number) {
    beginAgain(weightsOf(number));
    end = search(stop);
    // An exact search goes on until nothing better can be left; the others leave off at a plan.
    while (end == RunEnd::kBetterPlan && weights_.exact()) end = search(stop);
  }
  SearchResult result =
      best_leaf_ >= 0 ? finish(best_leaf_, best_end_) : finish(farthest_, SearchEnd::kProgress);
  result.exhausted = end == RunEnd::kExhausted;
  return result;
}

void PatternSearch::begin(const SearchProblem& problem) {
  problem_ = &problem;
  nodes_.clear();
  leaf_to_root_.clear();
  expansions_ = 0;
  best_leaf_ = -1;
  best_end_ = SearchEnd::kNothing;
  best_cost_ = kNever;
  prepareHeuristic();
  way_at_start_ = problem.distance_to_goal == nullptr
                      ? 0.0
                      : problem.distance_to_goal->length(problem.T_map_start.position());
}

void PatternSearch::prepareHeuristic() {
  const PatternTable& patterns = *problem_->patterns;
  speed_ = patterns.bestSpeed();
  per_cell_ = 1.0 / (problem_->cell > 0.0 ? problem_->cell : config_.cell);
  const auto bins = static_cast<float>(config_.heading_bins);
  bins_per_radian_ = bins / static_cast<float>(2.0 * kPi);
  first_bin_ = bins + 0.5F;
  goal_yaw_ = static_cast<float>(wrapAngle(problem_->goal.T_map_goal.yaw));
  yaw_tolerance_ = static_cast<float>(problem_->goal.yaw_tolerance);
  for (size_t i = 0; i < 2; ++i) {
    metre_cost_[i] = static_cast<float>(patterns.leastCosts()[i].per_metre);
    radian_cost_[i] = static_cast<float>(patterns.leastCosts()[i].per_radian);
  }
  const bool straight = problem_->distance_to_goal == nullptr;
  slack_ = straight ? 0.0F : static_cast<float>(problem_->distance_to_goal->cellSlack());
  way_share_ = straight ? 1.0F : static_cast<float>(DistanceToGoal::kAdmissibleShare);
  distance_share_ = static_cast<float>(config_.distance_share);
}

PatternSearch::Weights PatternSearch::weightsOf(int number) const {
  // From the greedy ones to 1 and 0, in equal ratios and equal steps.
  const double share = config_.improvements == 0
                           ? 0.0
                           : std::min(1.0, static_cast<double>(number) / config_.improvements);
  return {static_cast<float>(std::pow(config_.heuristic_weight, 1.0 - share)),
          static_cast<float>(config_.turn_weight * (1.0 - share))};
}

void PatternSearch::beginAgain(const Weights& weights) {
  weights_ = weights;
  keepBranch();
  best_.clear();
  farthest_ = -1;
  const SearchProblem& problem = *problem_;
  Node root{};
  root.x = problem.T_map_start.x;
  root.y = problem.T_map_start.y;
  root.yaw = wrapped(static_cast<float>(wrapAngle(problem.T_map_start.yaw)));
  root.cos_yaw = static_cast<float>(std::cos(problem.T_map_start.yaw));
  root.sin_yaw = static_cast<float>(std::sin(problem.T_map_start.yaw));
  root.parent = -1;
  root.number = -1;
  root.uncertainty = problem.start_uncertainty;
  root.motion_class = static_cast<int8_t>(problem.start_class);
  if (problem.cell_costs == nullptr) {
    const CollisionChecker& around = *problem.collision_checker;
    root.level = static_cast<int8_t>(
        around.freeLevel(problem.T_map_start, around.level(problem.start_uncertainty)));
    if (root.level < 0) root.overlap = around.overlap(problem.T_map_start);
  }
  const Heuristic to_go = heuristic(root, root.level < 0);
  root.admissible = to_go.admissible;
  root.inflated = inflated_at_start_ = to_go.inflated;
  // Estimates hardly fall below that at the start.
  open_.clear(std::isfinite(root.inflated) ? 0.5F * root.inflated : 0.0F);
  NodeTable::Entry& slot = best_[keyOf(root)];
  slot.cost = 0.0F;
  slot.node = static_cast<int>(nodes_.size());
  nodes_.push_back(root);
  open_.push(0.0F, slot.node, 0.0F);
}

/// Of what was searched before only the best plan is kept, at the front.
void PatternSearch::keepBranch() {
  kept_ = 0;
  if (best_leaf_ < 0) return nodes_.clear();
  std::vector<Node> branch;
  for (int i = best_leaf_; i >= 0; i = nodes_[static_cast<size_t>(i)].parent)
    branch.push_back(nodes_[static_cast<size_t>(i)]);
  std::reverse(branch.begin(), branch.end());
  for (size_t i = 0; i < branch.size(); ++i) branch[i].parent = static_cast<int>(i) - 1;
  nodes_.clear();
  for (const Node& node : branch) nodes_.push_back(node);
  best_leaf_ = static_cast<int>(nodes_.size()) - 1;
  kept_ = nodes_.size();
}

void PatternSearch::keepBest(int leaf, SearchEnd end) {
  const Node& node = nodes_[static_cast<size_t>(leaf)];
  best_leaf_ = leaf;
  best_end_ = end;
  best_cost_ = node.cost + node.admissible;
  if (problem_->on_better) problem_->on_better(static_cast<double>(best_cost_), expansions_);
}

void PatternSearch::noteProgress(int index) {
  const Node& node = nodes_[static_cast<size_t>(index)];
  const float limit = inflated_at_start_ - static_cast<float>(config_.least_progress);
  if (node.inflated >= limit || onBranch(node)) return;
  const float value = node.inflated + kLeafCost * node.cost;
  if (farthest_ >= 0 && value >= farthest_value_) return;
  farthest_ = index;
  farthest_value_ = value;
}

}  // namespace tread::planner
