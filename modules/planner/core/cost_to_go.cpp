// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/cost_to_go.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tread::planner {
namespace {

constexpr float kNoWay = std::numeric_limits<float>::infinity();
constexpr float kUnknownCap = 10.0F;
/// Cells whose lengths differ by less than this may be settled in any order [m].
constexpr float kBucket = 0.05F;
/// Around vehicle and goal there is at least so much of the area, however far apart they are [m].
constexpr double kLeastMargin = 8.0;
/// Where the vehicle's own cell is too near to something, the best cell this near counts [m].
constexpr double kNearby = 0.5;

float slownessOf(float room, const FieldConfig& config) {
  if (room < static_cast<float>(config.inflation)) return kNoWay;
  const double tight =
      (config.wide - static_cast<double>(room)) / std::max(1e-3, config.wide - config.inflation);
  return static_cast<float>(1.0 + config.tight_weight * std::clamp(tight, 0.0, 1.0));
}

}  // namespace

/// Cells waiting to be settled, in buckets of nearly equal length.
struct CostToGo::Front {
  std::vector<std::vector<int>> buckets = std::vector<std::vector<int>>(256);
  size_t current = 0;
  size_t waiting = 0;

  void add(int cell, float length) {
    const size_t wanted = std::max(current, static_cast<size_t>(length / kBucket));
    buckets[std::min(wanted, current + buckets.size() - 1) % buckets.size()].push_back(cell);
    ++waiting;
  }
  std::vector<int> take() {
    while (buckets[current % buckets.size()].empty()) ++current;
    std::vector<int> cells;
    cells.swap(buckets[current % buckets.size()]);
    waiting -= cells.size();
    return cells;
  }
};

CostToGo::CostToGo(const PassageMap& map, const Goal& goal, const Eigen::Vector2d& p_vehicle,
                   const std::vector<Detour>& detours, const FieldConfig& config) {
  const double distance = (goal.T_map_goal.position() - p_vehicle).norm();
  if (!(distance <= config.max_distance)) {
    problem_ = "the goal is farther away than " + std::to_string(std::lround(config.max_distance)) +
               " m: give nearer ones on the way";
    return;
  }
  for (double margin = config.area_margin;; margin *= 2.0) {
    layOut(map, goal, p_vehicle, margin, config);
    paint(map, detours, config);
    if (march(goal, p_vehicle, config)) return;
    const double longest = size_ * std::max(width_, height_);
    if (goal_blocked_ || !touched_border_ || longest >= config.max_area - size_) break;
  }
  problem_ =
      goal_blocked_ ? "the goal lies on obstacles" : "obstacles enclose the goal or the vehicle";
}

void CostToGo::layOut(const PassageMap& map, const Goal& goal, const Eigen::Vector2d& p_vehicle,
                      double margin, const FieldConfig& config) {
  size_ = map.coarseSize();
  const Eigen::Vector2d p_goal = goal.T_map_goal.position();
  const Eigen::Vector2d middle = (p_goal + p_vehicle) / 2.0;
  const Eigen::Vector2d needed = (p_goal - p_vehicle).cwiseAbs() / 2.0;
  const Eigen::Vector2d half = (needed + Eigen::Vector2d::Constant(margin))
                                   .cwiseMin(config.max_area / 2.0)
                                   .cwiseMax(needed + Eigen::Vector2d::Constant(kLeastMargin));
  lower_x_ = static_cast<int>(std::floor((middle.x() - half.x()) / size_));
  lower_y_ = static_cast<int>(std::floor((middle.y() - half.y()) / size_));
  width_ = static_cast<int>(std::ceil(2.0 * half.x() / size_));
  height_ = static_cast<int>(std::ceil(2.0 * half.y() / size_));
  const auto cells = static_cast<size_t>(width_) * static_cast<size_t>(height_);
  slowness_.assign(cells, 1.0F);
  unknown_.assign(cells, 1);
  length_.assign(cells, kNoWay);
  until_unknown_.assign(cells, 0.0F);
  way_x_.assign(cells, 0.0F);
  way_y_.assign(cells, 0.0F);
  settled_.assign(cells, 0);
  cut_ = 0.0F;
  cut_short_ = touched_border_ = goal_blocked_ = false;
  filled_ = 0;
}

void CostToGo::paint(const PassageMap& map, const std::vector<Detour>& detours,
                     const FieldConfig& config) {
  const int side = map.coarsePerTile();
  for (const auto& [key, tile] : map.passages()) {
    const int left = key.first * side - lower_x_;
    const int bottom = key.second * side - lower_y_;
    for (int y = std::max(0, -bottom); y < std::min(side, height_ - bottom); ++y) {
      for (int x = std::max(0, -left); x < std::min(side, width_ - left); ++x) {
        const auto from = static_cast<size_t>(y * side + x);
        const auto to = static_cast<size_t>((bottom + y) * width_ + left + x);
        slowness_[to] = slownessOf(tile.room[from], config);
        unknown_[to] = tile.unknown[from];
      }
    }
  }
  for (const Detour& detour : detours) {
    for (int cell = 0; cell < width_ * height_; ++cell)
      if ((centreOf(cell) - detour.p_map).norm() < detour.radius)
        slowness_[static_cast<size_t>(cell)] *= static_cast<float>(1.0 + config.detour_weight);
  }
}

bool CostToGo::seed(const Goal& goal, Front& front) {
  const int reach = static_cast<int>(std::ceil(goal.position_tolerance / size_));
  const Eigen::Vector2d p_goal = goal.T_map_goal.position();
  const int own = cellAt(p_goal);
  bool any = false;
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      const int x = own % width_ + dx;
      const int y = own / width_ + dy;
      if (x < 0 || y < 0 || x >= width_ || y >= height_) continue;
      const int cell = y * width_ + x;
      const bool inside = (centreOf(cell) - p_goal).norm() <= goal.position_tolerance;
      if ((!inside && cell != own) || slowness_[static_cast<size_t>(cell)] == kNoWay) continue;
      length_[static_cast<size_t>(cell)] = 0.0F;
      front.add(cell, 0.0F);
      any = true;
    }
  }
  return any;
}

bool CostToGo::march(const Goal& goal, const Eigen::Vector2d& p_vehicle,
                     const FieldConfig& config) {
  Front front;
  goal_blocked_ = !seed(goal, front);
  if (goal_blocked_) return false;
  const auto further = static_cast<float>(config.reach);
  float stop_at = kNoWay;
  while (front.waiting > 0) {
    for (const int cell : front.take()) {
      if (settled_[static_cast<size_t>(cell)] != 0) continue;
      settle(cell);
      relax(cell, front);
    }
    cut_ = static_cast<float>(front.current) * kBucket;
    if (stop_at == kNoWay && std::isfinite(length(p_vehicle))) stop_at = cut_ + further;
    if (cut_ > stop_at) {
      cut_short_ = true;
      return true;
    }
  }
  return std::isfinite(length(p_vehicle));
}

void CostToGo::settle(int cell) {
  const auto index = static_cast<size_t>(cell);
  settled_[index] = 1;
  ++filled_;
  const int x = cell % width_;
  const int y = cell / width_;
  touched_border_ = touched_border_ || x == 0 || y == 0 || x == width_ - 1 || y == height_ - 1;
  float best = length_[index];
  float until = kUnknownCap;
  Eigen::Vector2f way(0.0F, 0.0F);
  const int steps[4][2] = {{-1, 0}, {1, 0}, {0, -1}, {0, 1}};
  for (const auto& [dx, dy] : steps) {
    const float value = valueOf(x + dx, y + dy);
    if (value >= length_[index]) continue;
    way += (length_[index] - value) * Eigen::Vector2f(float(dx), float(dy));
    if (value >= best) continue;
    best = value;
    until = until_unknown_[static_cast<size_t>((y + dy) * width_ + x + dx)] +
            (length_[index] - value) / slowness_[index];
  }
  if (way.squaredNorm() > 0.0F) way.normalize();
  way_x_[index] = way.x();
  way_y_[index] = way.y();
  until_unknown_[index] = unknown_[index] != 0 ? 0.0F : std::min(until, kUnknownCap);
}

/// Length at a cell, infinite outside and where it is blocked or not yet settled.
float CostToGo::valueOf(int x, int y) const {
  if (x < 0 || y < 0 || x >= width_ || y >= height_) return kNoWay;
  const auto index = static_cast<size_t>(y * width_ + x);
  return settled_[index] != 0 ? length_[index] : kNoWay;
}

void CostToGo::relax(int cell, Front& front) {
  const int cx = cell % width_;
  const int cy = cell / width_;
  const int neighbours[4][2] = {{cx - 1, cy}, {cx + 1, cy}, {cx, cy - 1}, {cx, cy + 1}};
  for (const auto& [x, y] : neighbours) {
    if (x < 0 || y < 0 || x >= width_ || y >= height_) continue;
    const auto index = static_cast<size_t>(y * width_ + x);
    if (settled_[index] != 0 || slowness_[index] == kNoWay) continue;
    const float step = slowness_[index] * static_cast<float>(size_);
    const float a = std::min(valueOf(x - 1, y), valueOf(x + 1, y));
    const float b = std::min(valueOf(x, y - 1), valueOf(x, y + 1));
    const float nearer = std::min(a, b);
    const float apart = std::abs(a - b);
    // Upwind solution of |grad| = slowness; one-sided where the two sides are too far apart.
    const float value = apart < step
                            ? (a + b + std::sqrt(2.0F * step * step - apart * apart)) / 2.0F
                            : nearer + step;
    if (value >= length_[index]) continue;
    length_[index] = value;
    front.add(y * width_ + x, value);
  }
}

double CostToGo::length(const Eigen::Vector2d& p_map) const {
  if (empty()) return static_cast<double>(kNoWay);
  const double gx = p_map.x() / size_ - lower_x_ - 0.5;
  const double gy = p_map.y() / size_ - lower_y_ - 0.5;
  const int x = static_cast<int>(std::floor(gx));
  const int y = static_cast<int>(std::floor(gy));
  const double fx = gx - x;
  const double fy = gy - y;
  const double weights[4] = {(1 - fx) * (1 - fy), fx * (1 - fy), (1 - fx) * fy, fx * fy};
  double sum = 0.0;
  double weight = 0.0;
  for (int k = 0; k < 4; ++k) {
    const float value = valueOf(x + k % 2, y + k / 2);
    if (value == kNoWay) continue;
    sum += weights[k] * static_cast<double>(value);
    weight += weights[k];
  }
  if (weight > 0.05) return sum / weight;
  const bool passable = slowness_[static_cast<size_t>(cellAt(p_map))] != kNoWay;
  if (passable && cut_short_) return static_cast<double>(cut_);
  return lengthNearby(p_map);
}

double CostToGo::lengthNearby(const Eigen::Vector2d& p_map) const {
  const int reach = static_cast<int>(std::ceil(kNearby / size_));
  const int own = cellAt(p_map);
  double best = static_cast<double>(kNoWay);
  for (int dy = -reach; dy <= reach; ++dy) {
    for (int dx = -reach; dx <= reach; ++dx) {
      const int x = own % width_ + dx;
      const int y = own / width_ + dy;
      const float value = valueOf(x, y);
      if (value == kNoWay) continue;
      const double away = (centreOf(y * width_ + x) - p_map).norm();
      if (away <= kNearby) best = std::min(best, static_cast<double>(value) + away);
    }
  }
  return best;
}

double CostToGo::untilUnknown(const Eigen::Vector2d& p_map) const {
  if (empty()) return 0.0;
  const auto cell = static_cast<size_t>(cellAt(p_map));
  if (settled_[cell] != 0) return static_cast<double>(until_unknown_[cell]);
  return unknown_[cell] != 0 ? 0.0 : static_cast<double>(kUnknownCap);
}

Eigen::Vector2d CostToGo::direction(const Eigen::Vector2d& p_map) const {
  if (empty()) return {0.0, 0.0};
  const auto cell = static_cast<size_t>(cellAt(p_map));
  return {static_cast<double>(way_x_[cell]), static_cast<double>(way_y_[cell])};
}

std::vector<Eigen::Vector2d> CostToGo::descend(const Eigen::Vector2d& p_map, double step,
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

int CostToGo::cellAt(const Eigen::Vector2d& p_map) const {
  const int x = static_cast<int>(std::floor(p_map.x() / size_)) - lower_x_;
  const int y = static_cast<int>(std::floor(p_map.y() / size_)) - lower_y_;
  return std::clamp(y, 0, height_ - 1) * width_ + std::clamp(x, 0, width_ - 1);
}

Eigen::Vector2d CostToGo::centreOf(int cell) const {
  return {(lower_x_ + cell % width_ + 0.5) * size_, (lower_y_ + cell / width_ + 0.5) * size_};
}

bool CostToGo::covers(const Eigen::Vector2d& p_map, double reach) const {
  const Eigen::Vector2d lower(lower_x_ * size_ + reach, lower_y_ * size_ + reach);
  const Eigen::Vector2d upper((lower_x_ + width_) * size_ - reach,
                              (lower_y_ + height_) * size_ - reach);
  return !empty() && (p_map.array() >= lower.array()).all() &&
         (p_map.array() <= upper.array()).all();
}

}  // namespace tread::planner
