// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/search/pattern_search.hpp"

#include <algorithm>
#include <cmath>

namespace tread::planner {
namespace {

/// The predicate is asked once per so many expansions.
constexpr int kAskEvery = 16;
/// Where progress is slow the search looks so many times the horizon ahead.
constexpr float kLookAhead = 2.0F;
/// Patterns so short that they do not leave a cell in so many repetitions lead nowhere.
constexpr int kMostRepeats = 32;
/// What is cheaper by less than this share is not cheaper.
constexpr float kSame = 1e-6F;

uint64_t cellBits(double coordinate, double per_cell) {
  const double cells = coordinate * per_cell;
  const auto whole = static_cast<int64_t>(cells);
  return static_cast<uint64_t>(whole - static_cast<int64_t>(cells < static_cast<double>(whole))) &
         0xFFFFFU;
}

}  // namespace

PatternSearch::RunEnd PatternSearch::search(const StopPredicate& stop) {
  while (!open_.empty()) {
    const OpenList::Entry entry = open_.take();
    const Node& node = nodes_[static_cast<size_t>(entry.node)];
    // What was replaced since it was put in, or cannot be part of a better plan any more.
    if (node.expanded() || node.cost != entry.cost) continue;
    if (node.cost + node.admissible >= best_cost_ * (1.0F - kSame)) continue;
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
  if (!onBranch(node) && isGoal(node)) {
    keepBest(index, SearchEnd::kGoal);
    return true;
  }
  if (!onBranch(node) && isFarEnough(node)) {
    keepBest(index, SearchEnd::kHorizon);
    return true;
  }
  if (node.time < kLookAhead * static_cast<float>(config_.horizon)) expand(index);
  return false;
}

Uncertainty PatternSearch::uncertaintyAfter(const Node& parent, const TablePattern& pattern) const {
  const Eigen::Vector2d step = pattern.end().pose.position();
  const auto x = static_cast<float>(step.x());
  const auto y = static_cast<float>(step.y());
  const float c = parent.cos_yaw;
  const float s = parent.sin_yaw;
  return compose(parent.uncertainty, pattern.uncertainty, c * x - s * y, s * x + c * y, c, s);
}

void PatternSearch::expand(int parent) {
  const Node& node = nodes_[static_cast<size_t>(parent)];
  const int bin = headingBin(node);
  from_key_ = keyOf(node);
  children_.clear();
  for (const TablePattern* pattern : problem_->patterns->from(node.motion_class)) {
    if (pattern->start_bin >= 0 && pattern->start_bin != bin) continue;
    if (onBranch(node) && pattern->id() != problem_->branch[static_cast<size_t>(node.depth)])
      continue;
    Child child{nodeAfter(node, *pattern), 0};
    child.node.parent = parent;
    child.key = keyOf(child.node);
    // The table is larger than the caches: it is fetched while the others are worked out.
    best_.prefetch(child.key);
    children_.push_back(child);
  }
  for (Child& child : children_) addChild(child.node, child.key);
}

/// The node after a pattern, as far as it is cheap to know.
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
  node.cost = from.cost + edgeCost(from, pattern, node) + switchPenalty(from, pattern);
  node.time = from.time + static_cast<float>(pattern.duration);
  node.motion_class = static_cast<int8_t>(pattern.exit);
  node.depth = static_cast<int16_t>(from.depth + 1);
  node.on_plan = static_cast<int16_t>(staysOnPlan(from, pattern) ? from.on_plan + 1 : -1);
  node.number = -1;
  node.by = &pattern;
  node.repeats = 1;
  return node;
}

void PatternSearch::addChild(Node& node, uint64_t key) {
  const int parent = node.parent;
  if (key == from_key_) {
    // It would be no better than where it came from: it is repeated until it leaves the cell.
    if (!leaveCell(nodes_[static_cast<size_t>(parent)], node)) return;
    key = keyOf(node);
  }
  NodeTable::Entry& slot = best_[key];
  if (slot.node >= 0 && slot.cost <= node.cost * (1.0F + kSame)) return;
  const Node& from = nodes_[static_cast<size_t>(parent)];
  const DistanceToGoal* const way = problem_->distance_to_goal;
  // Where the way takes long to find out the ground is blocked more often than not.
  const bool is_slow = way != nullptr && !way->isSettled(node.x, node.y);
  if (is_slow && node.repeats == 1 && !admit(from, node)) return;
  const Heuristic to_go = heuristic(node, from.level < 0);
  if (node.cost + to_go.admissible >= best_cost_) return;
  node.admissible = to_go.admissible;
  node.inflated = to_go.inflated;
  if (!is_slow && node.repeats == 1 && !admit(from, node)) return;
  const bool waits = slot.node >= 0 && !nodes_[static_cast<size_t>(slot.node)].expanded();
  if (waits)
    nodes_[static_cast<size_t>(slot.node)] = node;
  else
    slot.node = static_cast<int>(nodes_.size());
  slot.cost = node.cost;
  open_.push(node.cost + node.inflated, slot.node, node.cost);
  if (!waits) nodes_.push_back(node);
}

bool PatternSearch::leaveCell(const Node& from, Node& node) const {
  if (!admit(from, node)) return false;
  while (keyOf(node) == from_key_) {
    if (node.repeats >= kMostRepeats) return false;
    Node next = nodeAfter(node, *node.by);
    next.parent = node.parent;
    next.repeats = static_cast<int8_t>(node.repeats + 1);
    if (!admit(node, next)) return false;
    node = next;
  }
  return true;
}

bool PatternSearch::admit(const Node& parent, Node& node) const {
  if (problem_->cell_costs != nullptr) {
    node.level = 0;
    return node.cost < kNever;
  }
  return freeFromParent(parent, node) && canStop(node);
}

bool PatternSearch::freeFromParent(const Node& parent, Node& node) const {
  const CollisionChecker& around = *problem_->collision_checker;
  if (parent.level < 0) {
    if (parent.depth >= config_.escape_patterns) return false;
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

bool PatternSearch::canStop(const Node& node) const {
  if (node.motion_class == problem_->patterns->restClass()) return true;
  const CollisionChecker& around = *problem_->collision_checker;
  const auto& stops = problem_->patterns->stopsFrom(node.motion_class);
  return std::any_of(stops.begin(), stops.end(), [&](const TablePattern* stop) {
    return node.level < 0 ? around.escape(node.plainPose(), node.overlap, *stop).has_value()
                          : around.sweepFree(node.pose(), *stop, node.level);
  });
}

/// Whether what follows a node is given.
bool PatternSearch::onBranch(const Node& parent) const {
  return static_cast<size_t>(parent.depth) < problem_->branch.size();
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
  if (time < config_.horizon) return false;
  const double gained_way = way_at_start_ - problem_->distance_to_goal->length(p);
  return gained_way >= config_.least_rate * speed_ * time;
}

int PatternSearch::headingBin(const Node& node) const {
  // A node's yaw is within half a turn: from half of the bins to one and a half times as many.
  int bin = static_cast<int>(node.yaw * bins_per_radian_ + first_bin_);
  while (bin >= config_.heading_bins) bin -= config_.heading_bins;
  return bin;
}

uint64_t PatternSearch::keyOf(const Node& node) const {
  return cellBits(node.x, per_cell_) | cellBits(node.y, per_cell_) << 20U |
         static_cast<uint64_t>(headingBin(node)) << 40U |
         static_cast<uint64_t>(node.motion_class) << 48U;
}

}  // namespace tread::planner
