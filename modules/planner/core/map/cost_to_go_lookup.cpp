// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// What is read from a way to go that was worked out.
#include <algorithm>
#include <cmath>

#include "modules/planner/core/map/cost_to_go.hpp"

namespace tread::planner {
namespace {

/// Where the vehicle's own cell is too near to something, the best cell this near counts [m].
constexpr double kNearby = 0.5;

}  // namespace

double CostToGo::length(const Eigen::Vector2d& p_map) const {
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

double CostToGo::lengthNearby(const Eigen::Vector2d& p_map) const {
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

float CostToGo::untilUnknownUnsettled(const Eigen::Vector2d& p_map) const {
  if (empty()) return 0.0F;
  const size_t cell = cellAt(p_map);
  if (settled_[cell] < kOpen) return slopes_[cell].until_unknown;
  return unknown_[cell] != 0 ? 0.0F : kUnknownCap;
}

Eigen::Vector2d CostToGo::direction(const Eigen::Vector2d& p_map) const {
  if (empty()) return {0.0, 0.0};
  const size_t cell = cellAt(p_map);
  if (settled_[cell] == kOpen) return {0.0, 0.0};
  return {static_cast<double>(slopes_[cell].along_x), static_cast<double>(slopes_[cell].along_y)};
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

std::optional<Eigen::Vector2d> CostToGo::nearestWithinReach(
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
size_t CostToGo::cellAt(const Eigen::Vector2d& p_map) const {
  const double x = std::clamp(std::floor(p_map.x() / size_) - lower_x_, 0.0, width_ - 1.0);
  const double y = std::clamp(std::floor(p_map.y() / size_) - lower_y_, 0.0, height_ - 1.0);
  return static_cast<size_t>((static_cast<int>(y) + 1) * stride_ + static_cast<int>(x) + 1);
}

Eigen::Vector2d CostToGo::centreOf(size_t cell) const {
  const auto stride = static_cast<size_t>(stride_);
  return {(lower_x_ + static_cast<double>(cell % stride) - 0.5) * size_,
          (lower_y_ + static_cast<double>(cell / stride) - 0.5) * size_};
}

bool CostToGo::covers(const Eigen::Vector2d& p_map, double reach) const {
  const Eigen::Vector2d lower(lower_x_ * size_ + reach, lower_y_ * size_ + reach);
  const Eigen::Vector2d upper((lower_x_ + width_) * size_ - reach,
                              (lower_y_ + height_) * size_ - reach);
  return !empty() && (p_map.array() >= lower.array()).all() &&
         (p_map.array() <= upper.array()).all();
}

}  // namespace tread::planner
