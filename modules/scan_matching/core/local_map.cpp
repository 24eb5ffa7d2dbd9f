// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/scan_matching/core/local_map.hpp"

#include <algorithm>
#include <cmath>

namespace tread::scan_matching {
namespace {

Eigen::Vector2d turned(double yaw, const Eigen::Vector2d& v) {
  return Pose2{0.0, 0.0, yaw} * v;
}

constexpr int kBlur = 2;  // [cells] around a point of the map

/// Lower left and upper right of all points.
std::pair<Eigen::Vector2d, Eigen::Vector2d> extentOf(const std::vector<ScanPoint>& points) {
  Eigen::Vector2d low = points.front().p;
  Eigen::Vector2d high = low;
  for (const ScanPoint& point : points) {
    low = low.cwiseMin(point.p);
    high = high.cwiseMax(point.p);
  }
  return {low, high};
}

}  // namespace

void LocalMap::clear() {
  scans_.clear();
  points_.clear();
  columns_ = rows_ = 0;
}

void LocalMap::add(const Pose2& T_map_body, const std::vector<ScanPoint>& points) {
  KeyScan scan{T_map_body, points};
  for (ScanPoint& point : scan.points) {
    point.p = T_map_body * point.p;
    point.normal = turned(T_map_body.yaw, point.normal);
  }
  scans_.push_back(std::move(scan));
  if (scans_.size() > most_) scans_.pop_front();
  collect();
  index();
}

void LocalMap::collect() {
  points_.clear();
  const Eigen::Vector2d middle = newest().position();
  for (const KeyScan& scan : scans_)
    for (const ScanPoint& point : scan.points)
      if ((point.p - middle).squaredNorm() <= reach_ * reach_) points_.push_back(point);
}

int LocalMap::column(double x) const {
  return static_cast<int>(std::floor((x - low_.x()) / kCell));
}

int LocalMap::row(double y) const {
  return static_cast<int>(std::floor((y - low_.y()) / kCell));
}

/// Sorts the points by cell (counting sort).
void LocalMap::index() {
  columns_ = rows_ = 0;
  if (points_.empty()) return;
  const auto [low, high] = extentOf(points_);
  low_ = low;
  columns_ = column(high.x()) + 1;
  rows_ = row(high.y()) + 1;
  const auto cellOf = [&](const ScanPoint& point) {
    return static_cast<size_t>(row(point.p.y()) * columns_ + column(point.p.x()));
  };
  starts_.assign(static_cast<size_t>(columns_ * rows_) + 1, 0);
  for (const ScanPoint& point : points_) ++starts_[cellOf(point) + 1];
  for (size_t cell = 1; cell < starts_.size(); ++cell) starts_[cell] += starts_[cell - 1];
  std::vector<uint32_t> next(starts_.begin(), starts_.end() - 1);
  std::vector<ScanPoint> sorted(points_.size());
  for (const ScanPoint& point : points_) sorted[next[cellOf(point)]++] = point;
  points_ = std::move(sorted);
}

const ScanPoint* LocalMap::nearest(const Eigen::Vector2d& p_map, double radius,
                                   const Eigen::Vector2d& p_map_sensor) const {
  const ScanPoint* found = nullptr;
  double least = radius * radius;
  const int left = std::max(0, column(p_map.x() - radius));
  const int right = std::min(columns_ - 1, column(p_map.x() + radius));
  const int top = std::min(rows_ - 1, row(p_map.y() + radius));
  for (int y = std::max(0, row(p_map.y() - radius)); y <= top; ++y) {
    if (left > right) break;
    const auto begin = static_cast<size_t>(y * columns_ + left);
    const auto end = static_cast<size_t>(y * columns_ + right) + 1;
    for (uint32_t i = starts_[begin]; i < starts_[end]; ++i) {
      const ScanPoint& point = points_[i];
      const double distance = (point.p - p_map).squaredNorm();
      if (distance >= least) continue;
      // The other side of a thin wall is invisible from here.
      if (point.shape == Shape::kLine && point.normal.dot(p_map_sensor - point.p) < 0.0) continue;
      least = distance;
      found = &point;
    }
  }
  return found;
}

LikelihoodGrid::LikelihoodGrid(const std::vector<ScanPoint>& map_points) {
  if (map_points.empty()) return;
  const auto [low, high] = extentOf(map_points);
  low_ = low.array() - (kBlur + 1) * kCell;
  columns_ = static_cast<int>(std::floor((high.x() - low_.x()) / kCell)) + kBlur + 2;
  rows_ = static_cast<int>(std::floor((high.y() - low_.y()) / kCell)) + kBlur + 2;
  cells_.assign(static_cast<size_t>(columns_) * static_cast<size_t>(rows_), 0);
  for (const ScanPoint& point : map_points)
    raise(static_cast<int>(std::floor((point.p.x() - low_.x()) / kCell)),
          static_cast<int>(std::floor((point.p.y() - low_.y()) / kCell)));
}

/// A smooth peak at a cell: 255 in its middle, about a tenth at the edge.
void LikelihoodGrid::raise(int x, int y) {
  for (int dy = -kBlur; dy <= kBlur; ++dy)
    for (int dx = -kBlur; dx <= kBlur; ++dx) {
      const auto value = static_cast<uint8_t>(255.0 * std::exp(-0.3 * (dx * dx + dy * dy)));
      uint8_t& cell = cells_[static_cast<size_t>(y + dy) * static_cast<size_t>(columns_) +
                             static_cast<size_t>(x + dx)];
      cell = std::max(cell, value);
    }
}

}  // namespace tread::scan_matching
