// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <vector>

#include "common/grid/grid.hpp"
#include "modules/planner/core/map/distance_to_goal.hpp"

namespace tread::planner {

/// Clearance in coarse cells of a static map, and the areas that are connected for a disc.
class CoarseClearance : public ClearanceSource {
 public:
  /// `coarse` cells of the grid make one side of a coarse cell; its clearance is the
  /// greatest at their centres, and 0 outside the grid.
  CoarseClearance(const Grid& grid, const ClearanceField& field, int coarse);

  double coarseSize() const override { return size_; }
  std::optional<ClearanceWindow> bounds() const override {
    return ClearanceWindow{lower_x_, lower_y_, width_, height_, {}, {}};
  }
  void fill(ClearanceWindow& window) const override;

  /// Numbers the areas in which a disc of this radius [m] can move; afterwards areaAt() answers.
  void label(double radius);
  /// Number of the area that a point lies in; 0 = no clearance for the disc, or outside.
  int areaAt(const Eigen::Vector2d& p_map) const;
  /// Numbers of the areas within a distance of a point [m].
  std::vector<int> areasNear(const Eigen::Vector2d& p_map, double distance) const;
  /// Centre of the coarse cell of these areas that is nearest to a point; nothing if there is none.
  std::optional<Eigen::Vector2d> nearestIn(const std::vector<int>& areas,
                                           const Eigen::Vector2d& p_map) const;

 private:
  size_t at(int x, int y) const {
    return static_cast<size_t>(y) * static_cast<size_t>(width_) + static_cast<size_t>(x);
  }
  bool contains(int x, int y) const { return x >= 0 && y >= 0 && x < width_ && y < height_; }
  Eigen::Vector2d centreOf(int x, int y) const {
    return {(lower_x_ + x + 0.5) * size_, (lower_y_ + y + 0.5) * size_};
  }
  void flood(int x, int y, int number, float radius);

  double size_;
  int lower_x_;
  int lower_y_;
  int width_;
  int height_;
  std::vector<float> clearance_;
  std::vector<uint8_t> unknown_;
  std::vector<int> area_;
};

}  // namespace tread::planner
