// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/grid/grid.hpp"

#include <algorithm>
#include <cmath>

namespace tread {
namespace {

/// Cell number along one axis; far away (and for NaN) a number no window contains, never an
/// overflow.
int cellNumber(double coordinate, double cell_size) {
  constexpr double kFarthest = 1e9;
  const double number = std::floor(coordinate / cell_size);
  if (!(number > -kFarthest)) return static_cast<int>(-kFarthest);
  return static_cast<int>(std::min(number, kFarthest));
}

}  // namespace

Grid::Grid(double cell_size, CellIndex lower, int width, int height)
    : cell_size_(cell_size),
      lower_(lower),
      width_(std::max(width, 0)),
      height_(std::max(height, 0)),
      cells_(static_cast<size_t>(width_) * static_cast<size_t>(height_), kUnknown) {}

CellIndex Grid::indexOf(const Eigen::Vector2d& p_map) const {
  return {cellNumber(p_map.x(), cell_size_), cellNumber(p_map.y(), cell_size_)};
}

Eigen::Vector2d Grid::centre(CellIndex index) const {
  return {(index.x + 0.5) * cell_size_, (index.y + 0.5) * cell_size_};
}

}  // namespace tread
