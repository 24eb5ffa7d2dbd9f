// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "modules/simulator/core/obstacle.hpp"
#include "modules/simulator/core/terrain.hpp"

namespace tread::sim {

/// A terrain's heights on a square raster, for the many look-ups of a laser scan.
class HeightTable {
 public:
  HeightTable() = default;
  /// Samples the terrain over an area; outside of it the border's height continues. Very large
  /// areas are sampled more coarsely.
  HeightTable(const Terrain& terrain, const Extent& area, double spacing);

  bool empty() const { return heights_.empty(); }
  /// Height between the samples, bilinear [m].
  double height(const Eigen::Vector2d& p_map) const;
  /// Largest slope between neighbouring samples along x or y, times sqrt(2): bounds all directions
  /// [1].
  double steepestSlope() const { return steepest_; }

 private:
  double at(int x, int y) const {
    return heights_[static_cast<size_t>(y) * static_cast<size_t>(columns_) +
                    static_cast<size_t>(x)];
  }

  Eigen::Vector2d low_ = Eigen::Vector2d::Zero();
  double spacing_ = 0.25;
  int columns_ = 0;
  int rows_ = 0;
  double steepest_ = 0.0;
  std::vector<double> heights_;  ///< columns x rows [m]
};

}  // namespace tread::sim
