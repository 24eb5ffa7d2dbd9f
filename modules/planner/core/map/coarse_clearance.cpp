// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/map/coarse_clearance.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace tread::planner {
namespace {

int floorDivide(int a, int b) {
  return a >= 0 ? a / b : -((b - 1 - a) / b);
}

}  // namespace

CoarseClearance::CoarseClearance(const Grid& grid, const ClearanceField& field, int coarse)
    : size_(grid.cellSize() * coarse),
      lower_x_(floorDivide(grid.lower().x, coarse)),
      lower_y_(floorDivide(grid.lower().y, coarse)),
      width_(floorDivide(grid.lower().x + grid.width() - 1, coarse) - lower_x_ + 1),
      height_(floorDivide(grid.lower().y + grid.height() - 1, coarse) - lower_y_ + 1) {
  if (grid.empty()) width_ = height_ = 0;
  const size_t cells = static_cast<size_t>(width_) * static_cast<size_t>(height_);
  clearance_.assign(cells, 0.0F);
  unknown_.assign(cells, 0);
  std::vector<size_t> columns(static_cast<size_t>(grid.width()));
  for (size_t x = 0; x < columns.size(); ++x)
    columns[x] =
        static_cast<size_t>(floorDivide(grid.lower().x + static_cast<int>(x), coarse) - lower_x_);
  std::vector<int> unknowns(cells, 0);
  for (int y = 0; y < grid.height(); ++y) {
    const size_t row = at(0, floorDivide(grid.lower().y + y, coarse) - lower_y_);
    const float* fine = field.row(y);
    const Cell* kinds = grid.cells().data() + grid.offset({grid.lower().x, grid.lower().y + y});
    for (size_t x = 0; x < columns.size(); ++x) {
      const size_t to = row + columns[x];
      clearance_[to] = std::max(clearance_[to], fine[x]);
      unknowns[to] += kinds[x] == kUnknown ? 1 : 0;
    }
  }
  for (size_t i = 0; i < cells; ++i) unknown_[i] = 2 * unknowns[i] >= coarse * coarse ? 1 : 0;
}

void CoarseClearance::fill(ClearanceWindow& window) const {
  for (int y = window.lower_y; y < window.lower_y + window.height; ++y) {
    for (int x = window.lower_x; x < window.lower_x + window.width; ++x) {
      const bool inside = contains(x - lower_x_, y - lower_y_);
      const size_t to = window.at(x, y);
      window.clearance[to] = inside ? clearance_[at(x - lower_x_, y - lower_y_)] : 0.0F;
      window.unknown[to] = inside ? unknown_[at(x - lower_x_, y - lower_y_)] : 1;
    }
  }
}

void CoarseClearance::label(double radius) {
  area_.assign(clearance_.size(), 0);
  int areas = 0;
  const auto needed = static_cast<float>(radius);
  for (int y = 0; y < height_; ++y)
    for (int x = 0; x < width_; ++x)
      if (area_[at(x, y)] == 0 && clearance_[at(x, y)] > 0.0F && clearance_[at(x, y)] >= needed)
        flood(x, y, ++areas, needed);
}

void CoarseClearance::flood(int x, int y, int number, float radius) {
  std::vector<std::pair<int, int>> open{{x, y}};
  area_[at(x, y)] = number;
  while (!open.empty()) {
    const auto [cx, cy] = open.back();
    open.pop_back();
    // Corners count as connected: what is told apart is apart.
    for (int dy = -1; dy <= 1; ++dy) {
      for (int dx = -1; dx <= 1; ++dx) {
        if (!contains(cx + dx, cy + dy)) continue;
        const size_t next = at(cx + dx, cy + dy);
        if (area_[next] != 0 || !(clearance_[next] > 0.0F) || clearance_[next] < radius) continue;
        area_[next] = number;
        open.emplace_back(cx + dx, cy + dy);
      }
    }
  }
}

int CoarseClearance::areaAt(const Eigen::Vector2d& p_map) const {
  const double x = std::floor(p_map.x() / size_) - lower_x_;
  const double y = std::floor(p_map.y() / size_) - lower_y_;
  if (!(x >= 0.0 && y >= 0.0 && x < width_ && y < height_)) return 0;
  return area_[at(static_cast<int>(x), static_cast<int>(y))];
}

std::vector<int> CoarseClearance::areasNear(const Eigen::Vector2d& p_map, double distance) const {
  std::vector<int> areas;
  const auto bound = [this](double value, int size) {
    // In this order what is no number counts as outside.
    return static_cast<int>(std::min(static_cast<double>(size), std::max(-1.0, value)));
  };
  // A cell's corner may be near enough although its centre is not.
  const double reach = distance + 0.71 * size_;
  const int x_from = bound(std::floor((p_map.x() - reach) / size_) - lower_x_, width_);
  const int x_to = bound(std::floor((p_map.x() + reach) / size_) - lower_x_, width_);
  const int y_from = bound(std::floor((p_map.y() - reach) / size_) - lower_y_, height_);
  const int y_to = bound(std::floor((p_map.y() + reach) / size_) - lower_y_, height_);
  for (int y = std::max(0, y_from); y <= std::min(height_ - 1, y_to); ++y) {
    for (int x = std::max(0, x_from); x <= std::min(width_ - 1, x_to); ++x) {
      const int area = area_[at(x, y)];
      if (area == 0 || (centreOf(x, y) - p_map).norm() > reach) continue;
      if (std::find(areas.begin(), areas.end(), area) == areas.end()) areas.push_back(area);
    }
  }
  return areas;
}

std::optional<Eigen::Vector2d> CoarseClearance::nearestIn(const std::vector<int>& areas,
                                                          const Eigen::Vector2d& p_map) const {
  std::optional<Eigen::Vector2d> nearest;
  double least = std::numeric_limits<double>::infinity();
  for (int y = 0; y < height_; ++y) {
    for (int x = 0; x < width_; ++x) {
      if (std::find(areas.begin(), areas.end(), area_[at(x, y)]) == areas.end()) continue;
      const double distance = (centreOf(x, y) - p_map).squaredNorm();
      if (distance >= least) continue;
      least = distance;
      nearest = centreOf(x, y);
    }
  }
  return nearest;
}

}  // namespace tread::planner
