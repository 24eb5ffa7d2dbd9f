// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/core/height_table.hpp"

#include <algorithm>
#include <cmath>

namespace tread::sim {
namespace {

constexpr double kMostSamples = 4e6;

}  // namespace

HeightTable::HeightTable(const Terrain& terrain, const Extent& area, double wanted_spacing)
    : low_(area.low) {
  const double spacing =
      std::max(wanted_spacing, std::sqrt((area.high - area.low).prod() / kMostSamples));
  spacing_ = spacing;
  const Eigen::Vector2d size = (area.high - area.low) / spacing;
  columns_ = static_cast<int>(std::ceil(size.x())) + 2;
  rows_ = static_cast<int>(std::ceil(size.y())) + 2;
  heights_.reserve(static_cast<size_t>(columns_) * static_cast<size_t>(rows_));
  for (int y = 0; y < rows_; ++y) {
    for (int x = 0; x < columns_; ++x) {
      heights_.push_back(terrain.height(low_ + spacing * Eigen::Vector2d(x, y)));
      const double along_x = x > 0 ? std::abs(at(x, y) - at(x - 1, y)) : 0.0;
      const double along_y = y > 0 ? std::abs(at(x, y) - at(x, y - 1)) : 0.0;
      steepest_ = std::max(steepest_, std::max(along_x, along_y) / spacing * std::sqrt(2.0));
    }
  }
}

double HeightTable::height(const Eigen::Vector2d& p_map) const {
  const double column = std::clamp((p_map.x() - low_.x()) / spacing_, 0.0, columns_ - 1.001);
  const double row = std::clamp((p_map.y() - low_.y()) / spacing_, 0.0, rows_ - 1.001);
  const int x = static_cast<int>(column);
  const int y = static_cast<int>(row);
  const double u = column - x;
  const double v = row - y;
  return (1.0 - v) * ((1.0 - u) * at(x, y) + u * at(x + 1, y)) +
         v * ((1.0 - u) * at(x, y + 1) + u * at(x + 1, y + 1));
}

}  // namespace tread::sim
