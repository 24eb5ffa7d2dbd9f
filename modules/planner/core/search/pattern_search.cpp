// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/search/pattern_search.hpp"

#include <algorithm>
#include <cmath>

namespace tread::planner {
namespace {

/// The predicate is polled once per this many expansions.
constexpr int kAskEvery = 16;
/// If progress is slow, the search looks this many horizons ahead.
constexpr float kLookAhead = 2.0F;
/// Patterns that do not leave a cell in this many repetitions lead nowhere.
constexpr int kMostRepeats = 32;
/// Patterns that a robot chooses within a horizon.
constexpr double kPatternsAhead = 6.0;
constexpr double kLeastHorizon = 1.0;  // [s]
/// Differences below this share count as equal.
constexpr float kSame = 1e-6F;
/// Share of the cost that counts against a leaf when the search is cut off.
constexpr float kLeafCost = 0.25F;

}  // namespace

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

StateGrid::StateGrid(double cell, int heading_bins)
    : per_cell_(1.0 / cell),
      heading_bins_(heading_bins),
      bins_per_radian_(static_cast<float>(heading_bins) / static_cast<float>(2.0 * kPi)),
      first_bin_(static_cast<float>(heading_bins) + 0.5F) {}

SearchResult PatternSearch::run(const SearchProblem& problem, const StopPredicate& stop) {
  begin(problem);
  RunEnd end = RunEnd::kBetterPlan;
  for (int number = 0; number <= config_.improvements && end == RunEnd::kBetterPlan; ++number) {
    beginAgain(weightsOf(number));
    end = search(stop);
    // An exact search continues until nothing better remains; the others stop at a plan.
    while (end == RunEnd::kBetterPlan && costs_.weights().exact()) end = search(stop);
  }
  SearchResult result = plan_.leaf >= 0 ? finish(plan_.leaf, plan_.end)
                                        : finish(progress_.leaf, SearchEnd::kProgress);
  result.exhausted = end == RunEnd::kExhausted;
  return result;
}

void PatternSearch::begin(const SearchProblem& problem) {
  problem_ = &problem;
  nodes_.clear();
  leaf_to_root_.clear();
  expansions_ = 0;
  horizon_ = config_.horizon > 0.0
                 ? config_.horizon
                 : std::max(kLeastHorizon, kPatternsAhead * problem.patterns->usualDuration());
  plan_ = Plan();
  costs_ = CostModel(config_, problem);
  checker_ = NodeChecker(config_, problem);
  grid_ = StateGrid(problem.cell > 0.0 ? problem.cell : config_.cell, config_.heading_bins);
  distance_at_start_ = problem.distance_to_goal == nullptr
                           ? 0.0
                           : problem.distance_to_goal->length(problem.T_map_start.position());
}

SearchWeights PatternSearch::weightsOf(int number) const {
  // From the greedy weights to 1 and 0, in equal ratios and equal steps.
  const double share = config_.improvements == 0
                           ? 0.0
                           : std::min(1.0, static_cast<double>(number) / config_.improvements);
  return {static_cast<float>(std::pow(config_.heuristic_weight, 1.0 - share)),
          static_cast<float>(config_.turn_weight * (1.0 - share))};
}

void PatternSearch::beginAgain(const SearchWeights& weights) {
  costs_.setWeights(weights);
  keepBestBranch();
  best_.clear();
  progress_.leaf = -1;
  const SearchProblem& problem = *problem_;
  Node root{};
  root.x = problem.T_map_start.x;
  root.y = problem.T_map_start.y;
  root.yaw = wrapped(static_cast<float>(wrapAngle(problem.T_map_start.yaw)));
  root.cos_yaw = static_cast<float>(std::cos(problem.T_map_start.yaw));
  root.sin_yaw = static_cast<float>(std::sin(problem.T_map_start.yaw));
  root.parent = -1;
  root.number = -1;
  root.motion_class = static_cast<int8_t>(problem.start_class);
  if (problem.rules == nullptr) {
    const CollisionChecker& around = *problem.collision_checker;
    root.level = static_cast<int8_t>(
        around.freeLevel(problem.T_map_start, around.level(problem.start_uncertainty)));
    if (root.level < 0) root.overlap = around.overlap(problem.T_map_start);
  }
  const CostModel::Heuristic to_go = costs_.heuristic(root, root.level < 0);
  root.admissible = to_go.admissible;
  root.inflated = inflated_at_start_ = to_go.inflated;
  // Estimates hardly fall below the one at the start.
  open_.clear(std::isfinite(root.inflated) ? 0.5F * root.inflated : 0.0F);
  NodeTable::Entry& slot = best_[grid_.keyOf(root)];
  slot.cost = 0.0F;
  slot.node = static_cast<int>(nodes_.size());
  nodes_.push_back(root);
  open_.push(0.0F, slot.node, 0.0F);
}

/// Of the earlier search only the best plan is kept, at the front.
void PatternSearch::keepBestBranch() {
  kept_ = 0;
  if (plan_.leaf < 0) return nodes_.clear();
  std::vector<Node> branch;
  for (int i = plan_.leaf; i >= 0; i = nodes_[static_cast<size_t>(i)].parent)
    branch.push_back(nodes_[static_cast<size_t>(i)]);
  std::reverse(branch.begin(), branch.end());
  for (size_t i = 0; i < branch.size(); ++i) branch[i].parent = static_cast<int>(i) - 1;
  nodes_.clear();
  for (const Node& node : branch) nodes_.push_back(node);
  plan_.leaf = static_cast<int>(nodes_.size()) - 1;
  kept_ = nodes_.size();
}

void PatternSearch::keepBest(int leaf, SearchEnd end) {
  const Node& node = nodes_[static_cast<size_t>(leaf)];
  plan_.leaf = leaf;
  plan_.end = end;
  plan_.cost = node.cost + node.admissible;
  if (problem_->on_better) problem_->on_better(static_cast<double>(plan_.cost), expansions_);
}

void PatternSearch::noteProgress(int index) {
  const Node& node = nodes_[static_cast<size_t>(index)];
  const float limit = inflated_at_start_ - static_cast<float>(config_.least_progress);
  if (node.inflated >= limit || checker_.onBranch(node)) return;
  const float value = node.inflated + kLeafCost * node.cost;
  if (progress_.leaf >= 0 && value >= progress_.value) return;
  progress_.leaf = index;
  progress_.value = value;
}

PatternSearch::RunEnd PatternSearch::search(const StopPredicate& stop) {
  while (!open_.empty()) {
    const OpenList::Entry entry = open_.take();
    const Node& node = nodes_[static_cast<size_t>(entry.node)];
    // Skips entries that were replaced since, or cannot be part of a better plan any more.
    if (node.expanded() || node.cost != entry.cost) continue;
    if (node.cost + node.admissible >= plan_.cost * (1.0F - kSame)) continue;
    const bool is_better = visit(entry.node);
    if (expansions_ % kAskEvery == 0 && (stop(expansions_) || nodes_.size() > config_.most_nodes))
      return RunEnd::kStopped;
    if (is_better) return RunEnd::kBetterPlan;
  }
  return RunEnd::kExhausted;
}

/// Returns whether the node ends a better plan.
bool PatternSearch::visit(int index) {
  ++expansions_;
  Node& node = nodes_[static_cast<size_t>(index)];
  node.number = expansions_;
  noteProgress(index);
  if (!checker_.onBranch(node) && isGoal(node)) {
    keepBest(index, SearchEnd::kGoal);
    return true;
  }
  if (!checker_.onBranch(node) && isFarEnough(node)) {
    keepBest(index, SearchEnd::kHorizon);
    return true;
  }
  if (node.time < kLookAhead * static_cast<float>(horizon_)) expand(index);
  return false;
}

void PatternSearch::expand(int parent) {
  const Node& node = nodes_[static_cast<size_t>(parent)];
  const EdgeRules* const rules = problem_->rules;
  const int bin = grid_.headingBin(node);
  from_key_ = grid_.keyOf(node);
  children_.clear();
  for (const TablePattern* pattern : problem_->patterns->from(node.motion_class)) {
    if (rules != nullptr && !rules->mayBegin(*pattern, bin)) continue;
    if (checker_.onBranch(node) &&
        pattern->id() != problem_->branch[static_cast<size_t>(node.depth)])
      continue;
    Child child{nodeAfter(node, *pattern), 0};
    child.node.parent = parent;
    child.key = grid_.keyOf(child.node);
    // The table is larger than the caches: prefetched while other children are computed.
    best_.prefetch(child.key);
    children_.push_back(child);
  }
  for (Child& child : children_) addChild(child.node, child.key);
}

/// The node after a pattern, as far as it is cheap to compute.
PatternSearch::Node PatternSearch::nodeAfter(const Node& from, const TablePattern& pattern) const {
  const SweptPose& end = pattern.end();
  const auto c = static_cast<double>(from.cos_yaw);
  const auto s = static_cast<double>(from.sin_yaw);
  Node node;
  node.x = from.x + c * end.pose.x - s * end.pose.y;
  node.y = from.y + s * end.pose.x + c * end.pose.y;
  node.yaw = wrapped(from.yaw + static_cast<float>(end.pose.yaw));
  node.cos_yaw = static_cast<float>(c * end.cos_yaw - s * end.sin_yaw);
  node.sin_yaw = static_cast<float>(s * end.cos_yaw + c * end.sin_yaw);
  node.cost =
      from.cost + costs_.edgeCost(from, pattern, node) + costs_.switchPenalty(from, pattern);
  node.time = from.time + static_cast<float>(pattern.duration);
  node.motion_class = static_cast<int8_t>(pattern.exit);
  node.depth = static_cast<int16_t>(from.depth + 1);
  node.on_plan = static_cast<int16_t>(costs_.staysOnPlan(from, pattern) ? from.on_plan + 1 : -1);
  node.number = -1;
  node.by = &pattern;
  node.repeats = 1;
  return node;
}

void PatternSearch::addChild(Node& node, uint64_t key) {
  const int parent = node.parent;
  if (key == from_key_) {
    // It would be no better than its parent: it is repeated until it leaves the cell.
    if (!leaveCell(nodes_[static_cast<size_t>(parent)], node)) return;
    key = grid_.keyOf(node);
  }
  NodeTable::Entry& slot = best_[key];
  if (slot.node >= 0 && slot.cost <= node.cost * (1.0F + kSame)) return;
  const Node& from = nodes_[static_cast<size_t>(parent)];
  const DistanceToGoal* const way = problem_->distance_to_goal;
  // Where the distance takes long to compute, the ground is mostly blocked.
  const bool is_slow = way != nullptr && !way->isSettled(node.x, node.y);
  if (is_slow && node.repeats == 1 && !checker_.admit(from, node)) return;
  const CostModel::Heuristic to_go = costs_.heuristic(node, from.level < 0);
  if (node.cost + to_go.admissible >= plan_.cost) return;
  node.admissible = to_go.admissible;
  node.inflated = to_go.inflated;
  if (!is_slow && node.repeats == 1 && !checker_.admit(from, node)) return;
  const bool waits = slot.node >= 0 && !nodes_[static_cast<size_t>(slot.node)].expanded();
  if (waits)
    nodes_[static_cast<size_t>(slot.node)] = node;
  else
    slot.node = static_cast<int>(nodes_.size());
  slot.cost = node.cost;
  const float estimate = node.cost + node.inflated + costs_.costToRest(node.motion_class);
  open_.push(estimate, slot.node, node.cost);
  if (!waits) nodes_.push_back(node);
}

bool PatternSearch::leaveCell(const Node& from, Node& node) const {
  if (!checker_.admit(from, node)) return false;
  while (grid_.keyOf(node) == from_key_) {
    if (node.repeats >= kMostRepeats) return false;
    Node next = nodeAfter(node, *node.by);
    next.parent = node.parent;
    next.repeats = static_cast<int8_t>(node.repeats + 1);
    if (!checker_.admit(node, next)) return false;
    node = next;
  }
  return true;
}

bool PatternSearch::isGoal(const Node& node) const {
  return node.motion_class == problem_->patterns->restClass() &&
         isWithin(problem_->goal, {node.x, node.y, static_cast<double>(node.yaw)},
                  config_.goal_share);
}

bool PatternSearch::isFarEnough(const Node& node) const {
  if (problem_->distance_to_goal == nullptr || node.depth == 0 || node.level < 0) return false;
  const float gained = inflated_at_start_ - node.inflated;
  if (gained < static_cast<float>(config_.least_progress)) return false;
  const Eigen::Vector2d p(node.x, node.y);
  if (problem_->distance_to_goal->untilUnknown(p) < config_.frontier) return true;
  const auto time = static_cast<double>(node.time);
  if (time < horizon_) return false;
  const double gained_way = distance_at_start_ - problem_->distance_to_goal->length(p);
  return gained_way >= config_.least_rate * costs_.bestSpeed() * time;
}

SearchResult PatternSearch::finish(int leaf, SearchEnd end) {
  SearchResult result;
  result.expansions = expansions_;
  if (leaf < 0) {
    result.reason = StopReason::kNoWayFound;
    if (expansions_ <= 1) result.reason.words = "no pattern is free from here";
    return result;
  }
  result.end = end;
  for (int i = leaf; i >= 0; i = nodes_[static_cast<size_t>(i)].parent) leaf_to_root_.push_back(i);
  // Nodes are partly in single precision: the plan's poses are recomputed.
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
  result.distance_to_go =
      any_field ? problem_->distance_to_goal->length({last.x, last.y})
                : (problem_->goal.T_map_goal.position() - Eigen::Vector2d(last.x, last.y)).norm();
  result.time_to_go = static_cast<double>(last.time) + result.distance_to_go / costs_.bestSpeed();
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

}  // namespace tread::planner
