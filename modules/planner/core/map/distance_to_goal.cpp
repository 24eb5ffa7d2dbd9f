// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/map/distance_to_goal.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <utility>

namespace tread::planner {
namespace {

constexpr float kOpenGround = 1e6F;
/// Cells whose lengths differ by less than this may be settled in any order [m].
constexpr float kBucket = 0.05F;
/// No step from a neighbour is shorter, in slowness times size of a cell: half a diagonal.
constexpr float kLeastStep = 0.707F;
/// Around vehicle and goal there is at least so much of the area, however far apart they are [m].
constexpr double kLeastMargin = 8.0;
/// Where the vehicle's own cell is too near to something, the best cell this near counts [m].
constexpr double kNearby = 0.5;

float slownessOf(float clearance, const DistanceFieldConfig& config) {
  if (clearance <= 0.0F || clearance < static_cast<float>(config.inflation))
    return std::numeric_limits<float>::infinity();
  const double tight = (config.wide - static_cast<double>(clearance)) /
                       std::max(1e-3, config.wide - config.inflation);
  return static_cast<float>(1.0 + config.tight_weight * std::clamp(tight, 0.0, 1.0));
}

}  // namespace

/// Cells waiting to be settled, in buckets of nearly equal length.
struct DistanceToGoal::Front {
  static constexpr size_t kBuckets = 256;  // a power of two: their number is found without division
  std::array<std::vector<uint32_t>, kBuckets> buckets;
  std::vector<uint32_t> taken;
  size_t current = 0;
  size_t waiting = 0;

  void add(size_t cell, float length) {
    const size_t wanted = std::max(current, static_cast<size_t>(length * (1.0F / kBucket)));
    const size_t bucket = std::min(wanted, current + kBuckets - 1) % kBuckets;
    buckets[bucket].push_back(static_cast<uint32_t>(cell));
    ++waiting;
  }
  const std::vector<uint32_t>& take() {
    while (buckets[current % kBuckets].empty()) ++current;
    taken.clear();
    taken.swap(buckets[current % kBuckets]);
    waiting -= taken.size();
    return taken;
  }
};

void DistanceToGoal::compute(const ClearanceSource& map, const Goal& goal,
                             const Eigen::Vector2d& p_vehicle, const std::vector<Detour>& detours,
                             const DistanceFieldConfig& config, const Interruption& interruption) {
  problem_.clear();
  const double distance = (goal.T_map_goal.position() - p_vehicle).norm();
  if (!(distance <= config.max_distance)) {
    *this = DistanceToGoal();
    problem_ = "the goal is farther away than " + std::to_string(std::lround(config.max_distance)) +
               " m: add intermediate goals";
    return;
  }
  for (double margin = config.area_margin;; margin *= 2.0) {
    layOut(map, goal, p_vehicle, margin, config);
    paint(map, detours, config);
    if (march(goal, p_vehicle, config, interruption)) return;
    const double longest = size_ * std::max(width_, height_);
    const bool all_seen = !touched_border_ || map.bounds().has_value();
    if (goal_blocked_ || all_seen || longest >= config.max_area - size_) break;
  }
  problem_ =
      goal_blocked_ ? "the goal lies on obstacles" : "obstacles enclose the goal or the vehicle";
}

/// A rectangle around goal and vehicle, with a margin.
void DistanceToGoal::chooseArea(const Eigen::Vector2d& p_goal, const Eigen::Vector2d& p_vehicle,
                                double margin, const DistanceFieldConfig& config) {
  const Eigen::Vector2d middle = (p_goal + p_vehicle) / 2.0;
  const Eigen::Vector2d needed = (p_goal - p_vehicle).cwiseAbs() / 2.0;
  const Eigen::Vector2d half = (needed + Eigen::Vector2d::Constant(margin))
                                   .cwiseMin(config.max_area / 2.0)
                                   .cwiseMax(needed + Eigen::Vector2d::Constant(kLeastMargin));
  lower_x_ = static_cast<int>(std::floor((middle.x() - half.x()) / size_));
  lower_y_ = static_cast<int>(std::floor((middle.y() - half.y()) / size_));
  width_ = static_cast<int>(std::ceil(2.0 * half.x() / size_));
  height_ = static_cast<int>(std::ceil(2.0 * half.y() / size_));
}

void DistanceToGoal::layOut(const ClearanceSource& map, const Goal& goal,
                            const Eigen::Vector2d& p_vehicle, double margin,
                            const DistanceFieldConfig& config) {
  size_ = map.coarseSize();
  if (const std::optional<ClearanceWindow> bounds = map.bounds()) {
    lower_x_ = bounds->lower_x;
    lower_y_ = bounds->lower_y;
    width_ = bounds->width;
    height_ = bounds->height;
  } else {
    chooseArea(goal.T_map_goal.position(), p_vehicle, margin, config);
  }
  stride_ = width_ + 2;
  per_size_ = 1.0 / size_;
  const auto cells = static_cast<size_t>(stride_) * static_cast<size_t>(height_ + 2);
  slowness_.assign(cells, kNoWay);
  unknown_.assign(cells, 1);
  tentative_.assign(cells, kNoWay);
  settled_.assign(cells, kOpen);
  slopes_.resize(cells);
  cut_ = 0.0F;
  cut_short_ = touched_border_ = goal_blocked_ = false;
  filled_ = 0;
}

void DistanceToGoal::paint(const ClearanceSource& map, const std::vector<Detour>& detours,
                           const DistanceFieldConfig& config) {
  ClearanceWindow window;
  window.lower_x = lower_x_;
  window.lower_y = lower_y_;
  window.width = width_;
  window.height = height_;
  window.clearance.assign(static_cast<size_t>(width_) * static_cast<size_t>(height_), kOpenGround);
  window.unknown.assign(window.clearance.size(), 1);
  map.fill(window);
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      const auto from = static_cast<size_t>(y) * static_cast<size_t>(width_) + size_t(x);
      const auto to = static_cast<size_t>((y + 1) * stride_ + x + 1);
      slowness_[to] = slownessOf(window.clearance[from], config);
      unknown_[to] = window.unknown[from];
    }
  }
  for (const Detour& detour : detours) {
    for (size_t cell = 0; cell < slowness_.size(); ++cell)
      if ((centreOf(cell) - detour.p_map).norm() < detour.radius)
        slowness_[cell] *= static_cast<float>(1.0 + config.detour_weight);
  }
}

bool DistanceToGoal::seed(const Goal& goal, Front& front) {
  const double most = width_ + height_;
  const int reach = static_cast<int>(std::min(std::ceil(goal.position_tolerance / size_), most));
  const Eigen::Vector2d p_goal = goal.T_map_goal.position();
  const int own_x = static_cast<int>(std::floor(p_goal.x() / size_)) - lower_x_;
  const int own_y = static_cast<int>(std::floor(p_goal.y() / size_)) - lower_y_;
  bool any = false;
  for (int y = std::max(0, own_y - reach); y <= std::min(height_ - 1, own_y + reach); ++y) {
    for (int x = std::max(0, own_x - reach); x <= std::min(width_ - 1, own_x + reach); ++x) {
      const auto cell = static_cast<size_t>((y + 1) * stride_ + x + 1);
      const bool inside = (centreOf(cell) - p_goal).norm() <= goal.position_tolerance;
      const bool own = x == own_x && y == own_y;
      if ((!inside && !own) || slowness_[cell] == kNoWay) continue;
      tentative_[cell] = 0.0F;
      front.add(cell, 0.0F);
      any = true;
    }
  }
  return any;
}

bool DistanceToGoal::march(const Goal& goal, const Eigen::Vector2d& p_vehicle,
                           const DistanceFieldConfig& config, const Interruption& interruption) {
  Front front;
  goal_blocked_ = !seed(goal, front);
  if (goal_blocked_) return false;
  const auto further = static_cast<float>(config.reach);
  float stop_at = kNoWay;
  while (front.waiting > 0) {
    for (const uint32_t cell : front.take()) {
      if (settled_[cell] < kOpen) continue;
      settle(cell);
      relax(cell, front);
    }
    cut_ = static_cast<float>(front.current) * kBucket;
    if (stop_at == kNoWay && std::isfinite(length(p_vehicle))) stop_at = cut_ + further;
    if (cut_ > stop_at || (interruption && interruption())) {
      cut_short_ = true;
      return true;
    }
  }
  return std::isfinite(length(p_vehicle));
}

void DistanceToGoal::settle(size_t cell) {
  ++filled_;
  const float own = tentative_[cell];
  const auto stride = static_cast<size_t>(stride_);
  const float left = settled_[cell - 1];
  const float right = settled_[cell + 1];
  const float below = settled_[cell - stride];
  const float above = settled_[cell + stride];
  settled_[cell] = own;
  const size_t column = cell % stride;
  const size_t row = cell / stride;
  touched_border_ = touched_border_ || column == 1 || row == 1 ||
                    column == static_cast<size_t>(width_) || row == static_cast<size_t>(height_);
  Slope& slope = slopes_[cell];
  slope = Slope{};
  slope.step = slowness_[cell] * static_cast<float>(size_);
  const float slowness = std::exchange(slowness_[cell], kNoWay);  // relax() looks no more at it
  const float x = std::min(left, right);
  const float y = std::min(below, above);
  const float along_x = x < own ? (left < right ? x - own : own - x) : 0.0F;
  const float along_y = y < own ? (below < above ? y - own : own - y) : 0.0F;
  const float norm = std::sqrt(along_x * along_x + along_y * along_y);
  if (norm > 0.0F) {
    slope.along_x = along_x / norm;
    slope.along_y = along_y / norm;
  }
  float until = kUnknownCap;
  if (std::min(x, y) < own) {
    const size_t next = x < y ? (left < right ? cell - 1 : cell + 1)
                              : (below < above ? cell - stride : cell + stride);
    until = slopes_[next].until_unknown + (own - settled_[next]) / slowness;
  }
  slope.until_unknown = unknown_[cell] != 0 ? 0.0F : std::min(until, kUnknownCap);
}

void DistanceToGoal::relax(size_t cell, Front& front) {
  const auto stride = static_cast<size_t>(stride_);
  const auto size = static_cast<float>(size_);
  for (const size_t next : {cell - 1, cell + 1, cell - stride, cell + stride}) {
    const float slowness = slowness_[next];
    if (slowness == kNoWay) continue;
    const float step = slowness * size;
    const float a = std::min(settled_[next - 1], settled_[next + 1]);
    const float b = std::min(settled_[next - stride], settled_[next + stride]);
    const float nearer = std::min(a, b);
    if (nearer + kLeastStep * step >= tentative_[next]) continue;
    const float apart = std::min(std::max(a, b) - nearer, step);
    // Upwind solution of |grad| = slowness; one-sided where the two sides are too far apart.
    const float value = nearer + 0.5F * (apart + std::sqrt(2.0F * step * step - apart * apart));
    if (value >= tentative_[next]) continue;
    tentative_[next] = value;
    front.add(next, value);
  }
}

double DistanceToGoal::length(const Eigen::Vector2d& p_map) const {
  if (empty()) return static_cast<double>(kNoWay);
  const double gx = std::clamp(p_map.x() / size_ - lower_x_ - 0.5, -1.0, double(width_));
  const double gy = std::clamp(p_map.y() / size_ - lower_y_ - 0.5, -1.0, double(height_));
  const int x = std::min(static_cast<int>(std::floor(gx)), width_ - 1);
  const int y = std::min(static_cast<int>(std::floor(gy)), height_ - 1);
  const double fx = gx - x;
  const double fy = gy - y;
  const double weights[4] = {(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy};
  double sum = 0.0;
  double weight = 0.0;
  for (int k = 0; k < 4; ++k) {
    const float value = settled_[static_cast<size_t>((y + 1 + k / 2) * stride_ + x + 1 + k % 2)];
    if (value == kNoWay) continue;
    sum += weights[k] * static_cast<double>(value);
    weight += weights[k];
  }
  if (weight > 0.05) return sum / weight;
  const size_t cell = cellAt(p_map);
  const bool passable = slowness_[cell] != kNoWay || settled_[cell] < kOpen;
  if (passable && cut_short_) return static_cast<double>(cut_);
  return lengthNearby(p_map);
}

double DistanceToGoal::lengthNearby(const Eigen::Vector2d& p_map) const {
  const int reach = static_cast<int>(std::ceil(kNearby / size_));
  const auto own = static_cast<int>(cellAt(p_map));
  const int own_x = own % stride_;
  const int own_y = own / stride_;
  double best = static_cast<double>(kNoWay);
  for (int y = std::max(1, own_y - reach); y <= std::min(height_, own_y + reach); ++y) {
    for (int x = std::max(1, own_x - reach); x <= std::min(width_, own_x + reach); ++x) {
      const auto cell = static_cast<size_t>(y * stride_ + x);
      // What is passable and was not filled in is as far as the longest way that was.
      const float open = cut_short_ && slowness_[cell] != kNoWay ? cut_ : kNoWay;
      const float way = std::min(settled_[cell], open);
      if (way == kNoWay) continue;
      const double away = (centreOf(cell) - p_map).norm();
      if (away <= kNearby) best = std::min(best, static_cast<double>(way) + away);
    }
  }
  return best;
}

float DistanceToGoal::untilUnknownUnsettled(const Eigen::Vector2d& p_map) const {
  if (empty()) return 0.0F;
  const size_t cell = cellAt(p_map);
  if (settled_[cell] < kOpen) return slopes_[cell].until_unknown;
  return unknown_[cell] != 0 ? 0.0F : kUnknownCap;
}

Eigen::Vector2d DistanceToGoal::direction(const Eigen::Vector2d& p_map) const {
  if (empty()) return {0.0, 0.0};
  const size_t cell = cellAt(p_map);
  if (settled_[cell] == kOpen) return {0.0, 0.0};
  return {static_cast<double>(slopes_[cell].along_x), static_cast<double>(slopes_[cell].along_y)};
}

std::vector<Eigen::Vector2d> DistanceToGoal::descend(const Eigen::Vector2d& p_map, double step,
                                                     int count) const {
  std::vector<Eigen::Vector2d> points;
  Eigen::Vector2d p = p_map;
  while (static_cast<int>(points.size()) < count) {
    const Eigen::Vector2d way = direction(p);
    if (way.squaredNorm() == 0.0) break;
    p += step * way;
    points.push_back(p);
  }
  return points;
}

std::optional<Eigen::Vector2d> DistanceToGoal::nearestWithinReach(
    const Eigen::Vector2d& p_vehicle, const Eigen::Vector2d& p_goal,
    const std::optional<Eigen::Vector2d>& before) const {
  if (empty()) return std::nullopt;
  const auto stride = static_cast<size_t>(stride_);
  std::vector<uint8_t> seen(slowness_.size(), 0);
  std::vector<size_t> waiting{cellAt(p_vehicle)};
  seen[waiting.back()] = 1;
  std::optional<Eigen::Vector2d> nearest;
  while (!waiting.empty()) {
    const size_t cell = waiting.back();
    waiting.pop_back();
    // Those that were settled are on the goal's side.
    if (slowness_[cell] == kNoWay) continue;
    const Eigen::Vector2d centre = centreOf(cell);
    if (!nearest || (centre - p_goal).norm() < (*nearest - p_goal).norm()) nearest = centre;
    for (const size_t next : {cell - 1, cell + 1, cell - stride, cell + stride}) {
      if (seen[next] == 0) waiting.push_back(next);
      seen[next] = 1;
    }
  }
  if (!before || !nearest) return nearest;
  const size_t cell = cellAt(*before);
  const bool still = seen[cell] != 0 && slowness_[cell] != kNoWay;
  const bool as_good = (*before - p_goal).norm() < (*nearest - p_goal).norm() + kMuchNearer;
  return still && as_good ? before : nearest;
}

/// The cell under a point; the nearest one for a point outside.
size_t DistanceToGoal::cellAt(const Eigen::Vector2d& p_map) const {
  const double x = std::clamp(std::floor(p_map.x() / size_) - lower_x_, 0.0, width_ - 1.0);
  const double y = std::clamp(std::floor(p_map.y() / size_) - lower_y_, 0.0, height_ - 1.0);
  return static_cast<size_t>((static_cast<int>(y) + 1) * stride_ + static_cast<int>(x) + 1);
}

Eigen::Vector2d DistanceToGoal::centreOf(size_t cell) const {
  const auto stride = static_cast<size_t>(stride_);
  return {(lower_x_ + static_cast<double>(cell % stride) - 0.5) * size_,
          (lower_y_ + static_cast<double>(cell / stride) - 0.5) * size_};
}

bool DistanceToGoal::covers(const Eigen::Vector2d& p_map, double reach) const {
  const Eigen::Vector2d lower(lower_x_ * size_ + reach, lower_y_ * size_ + reach);
  const Eigen::Vector2d upper((lower_x_ + width_) * size_ - reach,
                              (lower_y_ + height_) * size_ - reach);
  return !empty() && (p_map.array() >= lower.array()).all() &&
         (p_map.array() <= upper.array()).all();
}

}  // namespace tread::planner
