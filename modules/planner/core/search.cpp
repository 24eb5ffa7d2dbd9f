// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/search.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tread::planner {
namespace {

constexpr float kNever = std::numeric_limits<float>::infinity();
/// The predicate is asked once per so many expansions.
constexpr int kAskEvery = 16;
/// What a point within a coarse cell may be nearer than the cell's centre [m].
constexpr double kCellSlack = 0.15;
/// Nearer to the goal than this its heading counts, farther off that of the way [m].
constexpr double kNearGoal = 1.0;
/// Where progress is slow the search looks so many times the horizon ahead.
constexpr float kLookAhead = 2.0F;
/// Share of the cost that counts against a leaf when the search is cut off.
constexpr float kLeafCost = 0.25F;

uint64_t cellBits(double coordinate, double cell) {
  return static_cast<uint64_t>(static_cast<int64_t>(std::floor(coordinate / cell))) & 0xFFFFFU;
}

}  // namespace

SearchResult Search::run(const SearchProblem& problem, const StopPredicate& stop) {
  begin(problem);
  while (true) {
    const int index = take();
    if (index < 0) return finish(bestLeaf(), SearchEnd::kProgress);
    Node& node = nodes_[static_cast<size_t>(index)];
    if (!admit(node)) continue;
    ++expansions_;
    node.expanded = true;
    if (isGoal(node)) return finish(index, SearchEnd::kGoal);
    if (isFarEnough(node)) return finish(index, SearchEnd::kHorizon);
    if (node.time < kLookAhead * static_cast<float>(config_.horizon)) expand(index);
    if (expansions_ % kAskEvery == 0 && stop(expansions_))
      return finish(bestLeaf(), SearchEnd::kProgress);
  }
}

void Search::begin(const SearchProblem& problem) {
  problem_ = &problem;
  nodes_.clear();
  open_.clear();
  best_.clear();
  leaf_to_root_.clear();
  expansions_ = 0;
  speed_ = problem.patterns->bestSpeed();
  turn_rate_ = std::max(1e-3, problem.patterns->bestTurnRate());
  way_at_start_ = problem.cost_to_go->length(problem.T_map_start.position());
  Node root{};
  root.x = problem.T_map_start.x;
  root.y = problem.T_map_start.y;
  root.yaw = problem.T_map_start.yaw;
  root.to_go = toGo(problem.T_map_start);
  root.variance = static_cast<float>(problem.start_variance);
  root.parent = -1;
  root.motion_class = static_cast<int8_t>(problem.start_class);
  const Surroundings& around = *problem.surroundings;
  root.level = static_cast<int8_t>(
      around.freeLevel(problem.T_map_start, around.level(problem.start_variance)));
  if (root.level < 0) root.overlap = around.overlap(problem.T_map_start);
  nodes_.push_back(root);
  push(0);
}

void Search::push(int node) {
  const Node& entry = nodes_[static_cast<size_t>(node)];
  const float estimate = node == 0 ? 0.0F : entry.cost + entry.to_go;
  open_.push_back({estimate, node});
  std::push_heap(open_.begin(), open_.end(), [](const Open& a, const Open& b) {
    return a.estimate != b.estimate ? a.estimate > b.estimate : a.node < b.node;
  });
}

int Search::take() {
  if (open_.empty()) return -1;
  std::pop_heap(open_.begin(), open_.end(), [](const Open& a, const Open& b) {
    return a.estimate != b.estimate ? a.estimate > b.estimate : a.node < b.node;
  });
  const int node = open_.back().node;
  open_.pop_back();
  return node;
}

bool Search::admit(Node& node) {
  const uint64_t key = keyOf(node);
  const float* known = best_.find(key);
  if (known != nullptr && *known <= node.cost) return false;
  if (node.parent >= 0 && (!freeFromParent(node) || !canStop(node))) return false;
  best_.put(key, node.cost);
  return true;
}

bool Search::freeFromParent(Node& node) const {
  const Node& parent = nodes_[static_cast<size_t>(node.parent)];
  const Surroundings& around = *problem_->surroundings;
  const Pose2 start = parent.pose();
  if (parent.level < 0) {
    if (parent.depth >= config_.escape_patterns) return false;
    const std::optional<Overlap> left = around.escape(start, parent.overlap, *node.by);
    if (!left) return false;
    node.overlap = *left;
    node.level = static_cast<int8_t>(around.freeLevel(node.pose(), Surroundings::kPlan));
    return true;
  }
  const int wanted = around.level(static_cast<double>(node.variance));
  if (parent.level >= wanted) {
    node.level = static_cast<int8_t>(wanted);
    return around.sweepFree(start, *node.by, wanted);
  }
  if (!around.sweepRegains(start, parent.level, *node.by, wanted)) return false;
  node.level = static_cast<int8_t>(around.freeLevel(node.pose(), wanted));
  return true;
}

bool Search::canStop(const Node& node) const {
  if (node.motion_class == problem_->patterns->restClass()) return true;
  const Surroundings& around = *problem_->surroundings;
  const auto& stops = problem_->patterns->stopsFrom(node.motion_class);
  return std::any_of(stops.begin(), stops.end(), [&](const TablePattern* stop) {
    return node.level < 0 ? around.escape(node.pose(), node.overlap, *stop).has_value()
                          : around.sweepFree(node.pose(), *stop, node.level);
  });
}

void Search::expand(int parent) {
  const int motion_class = nodes_[static_cast<size_t>(parent)].motion_class;
  for (const TablePattern* pattern : problem_->patterns->from(motion_class))
    addChild(parent, *pattern);
}

void Search::addChild(int parent, const TablePattern& pattern) {
  const Node& from = nodes_[static_cast<size_t>(parent)];
  const Pose2 end = from.pose() * pattern.end().pose;
  const float to_go = toGo(end);
  if (to_go == kNever) return;
  Node node{};
  node.x = end.x;
  node.y = end.y;
  node.yaw = end.yaw;
  node.parent = parent;
  node.by = &pattern;
  node.depth = static_cast<int16_t>(from.depth + 1);
  node.motion_class = static_cast<int8_t>(pattern.exit);
  node.cost = from.cost + edgeCost(pattern, end) + switchPenalty(from, pattern);
  node.time = from.time + static_cast<float>(pattern.duration);
  node.to_go = to_go;
  node.variance = from.variance + static_cast<float>(pattern.variance);
  const bool on_plan = from.on_plan == from.depth &&
                       static_cast<size_t>(from.depth) < problem_->committed.size() &&
                       problem_->committed[static_cast<size_t>(from.depth)] == pattern.id();
  node.on_plan = static_cast<int16_t>(on_plan ? from.on_plan + 1 : -1);
  const float* known = best_.find(keyOf(node));
  if (known != nullptr && *known <= node.cost) return;
  nodes_.push_back(node);
  push(static_cast<int>(nodes_.size()) - 1);
}

float Search::edgeCost(const TablePattern& pattern, const Pose2& end) const {
  const double clearance = problem_->surroundings->clearance(end.position());
  const double near = std::max(0.0, 1.0 - clearance / config_.near_distance);
  double weight = 1.0 + config_.near_penalty * near;
  if (pattern.reverses) weight += config_.reverse_penalty;
  const int rest = problem_->patterns->restClass();
  const bool comes_to_rest = pattern.exit == rest && pattern.entry != rest;
  return static_cast<float>(pattern.duration * weight +
                            (comes_to_rest ? config_.stop_penalty : 0.0));
}

float Search::switchPenalty(const Node& parent, const TablePattern& pattern) const {
  const auto depth = static_cast<size_t>(parent.depth);
  if (parent.on_plan != parent.depth || depth >= problem_->committed.size()) return 0.0F;
  if (problem_->committed[depth] == pattern.id()) return 0.0F;
  return static_cast<float>(config_.switch_penalty * std::exp2(-parent.depth));
}

float Search::toGo(const Pose2& pose) const {
  const Eigen::Vector2d p = pose.position();
  const double way = problem_->cost_to_go->length(p);
  if (!std::isfinite(way)) return kNever;
  const double bounded = std::max(0.0, config_.bound_share * way - kCellSlack) / speed_;
  double off_goal = 0.0;
  if (problem_->goal.yaw_tolerance < kPi)
    off_goal = std::max(0.0, std::abs(wrapAngle(pose.yaw - problem_->goal.T_map_goal.yaw)) -
                                 problem_->goal.yaw_tolerance);
  const double bound = std::max(bounded, off_goal / turn_rate_);
  double turn = off_goal;
  if (config_.turn_weight > 0.0 && way > kNearGoal) {
    const Eigen::Vector2d along = problem_->cost_to_go->direction(p);
    const double cosine = along.x() * std::cos(pose.yaw) + along.y() * std::sin(pose.yaw);
    turn = std::acos(std::clamp(cosine, -1.0, 1.0));
  }
  return static_cast<float>(config_.bound_weight * bound + config_.turn_weight * turn / turn_rate_);
}

bool Search::isGoal(const Node& node) const {
  if (node.motion_class != problem_->patterns->restClass()) return false;
  const Goal& goal = problem_->goal;
  const Pose2& at = goal.T_map_goal;
  if (std::hypot(node.x - at.x, node.y - at.y) > config_.goal_share * goal.position_tolerance)
    return false;
  const double off = std::abs(wrapAngle(node.yaw - at.yaw));
  return goal.yaw_tolerance >= kPi || off <= config_.goal_share * goal.yaw_tolerance;
}

bool Search::isFarEnough(const Node& node) const {
  if (node.depth == 0 || node.level < 0) return false;
  const float gained = nodes_.front().to_go - node.to_go;
  if (gained < static_cast<float>(config_.least_progress)) return false;
  const Eigen::Vector2d p(node.x, node.y);
  if (problem_->cost_to_go->untilUnknown(p) < config_.frontier) return true;
  const auto time = static_cast<double>(node.time);
  const double gained_way = way_at_start_ - problem_->cost_to_go->length(p);
  return time >= config_.horizon && gained_way >= config_.least_rate * speed_ * time;
}

int Search::bestLeaf() const {
  int best = -1;
  float best_value = nodes_.front().to_go - static_cast<float>(config_.least_progress);
  for (size_t i = 1; i < nodes_.size(); ++i) {
    const Node& node = nodes_[i];
    if (!node.expanded || node.to_go >= nodes_.front().to_go - float(config_.least_progress))
      continue;
    const float value = node.to_go + kLeafCost * node.cost;
    if (best >= 0 && value >= best_value) continue;
    best = static_cast<int>(i);
    best_value = value;
  }
  return best;
}

uint64_t Search::keyOf(const Node& node) const {
  const double turns = node.yaw / (2.0 * kPi);
  const double share = turns - std::floor(turns);
  const auto heading = static_cast<uint64_t>(share * config_.heading_bins + 0.5) %
                       static_cast<uint64_t>(config_.heading_bins);
  return cellBits(node.x, config_.cell) | cellBits(node.y, config_.cell) << 20U | heading << 40U |
         static_cast<uint64_t>(node.motion_class) << 56U;
}

SearchResult Search::finish(int leaf, SearchEnd end) {
  SearchResult result;
  result.expansions = expansions_;
  if (leaf < 0) {
    result.reason = expansions_ <= 1 ? "no pattern is free from here"
                                     : "no free sequence of patterns brings the goal nearer";
    return result;
  }
  result.end = end;
  for (int i = leaf; i >= 0; i = nodes_[static_cast<size_t>(i)].parent) leaf_to_root_.push_back(i);
  for (auto it = leaf_to_root_.rbegin() + 1; it != leaf_to_root_.rend(); ++it) {
    const Node& node = nodes_[static_cast<size_t>(*it)];
    result.steps.push_back({node.by->id(), node.pose(), node.motion_class,
                            static_cast<double>(node.time), static_cast<double>(node.variance)});
  }
  const Node& last = nodes_[static_cast<size_t>(leaf)];
  result.cost = static_cast<double>(last.cost);
  result.way_to_go = problem_->cost_to_go->length({last.x, last.y});
  result.time_to_go = static_cast<double>(last.time) + result.way_to_go / speed_;
  return result;
}

std::vector<TreeNode> Search::tree(size_t count) const {
  std::vector<bool> wanted(nodes_.size(), false);
  size_t left = count;
  for (const int i : leaf_to_root_) {
    wanted[static_cast<size_t>(i)] = true;
    left -= left > 0 ? 1 : 0;
  }
  for (size_t i = 0; i < nodes_.size() && left > 0; ++i) {
    if (!nodes_[i].expanded || wanted[i]) continue;
    wanted[i] = true;
    --left;
  }
  std::vector<int> index(nodes_.size(), -1);
  std::vector<TreeNode> drawn;
  for (size_t i = 0; i < nodes_.size(); ++i) {
    if (!wanted[i]) continue;
    const Node& node = nodes_[i];
    index[i] = static_cast<int>(drawn.size());
    drawn.push_back({node.parent < 0 ? -1 : index[static_cast<size_t>(node.parent)],
                     node.by == nullptr ? -1 : node.by->id(), node.pose(),
                     static_cast<double>(node.time)});
  }
  branch_.clear();
  for (auto it = leaf_to_root_.rbegin(); it != leaf_to_root_.rend(); ++it)
    branch_.push_back(index[static_cast<size_t>(*it)]);
  return drawn;
}

}  // namespace tread::planner
