// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "common/fence/fence.hpp"
#include "common/grid/grid.hpp"
#include "modules/planner/core/map/distance_to_goal.hpp"

namespace tread::planner {

/// Ground forbidden by fences, enlarged by the distance that plans must keep from it.
class FencedGround {
 public:
  FencedGround() = default;
  /// `growth` [m]: the robot's stopping distance and position error.
  FencedGround(std::vector<Fence> fences, double growth)
      : fences_(std::move(fences)), growth_(growth) {}

  bool empty() const { return fences_.empty(); }
  double growth() const { return growth_; }
  const std::vector<Fence>& fences() const { return fences_; }

  /// Makes obstacles of all cells closer to forbidden ground than the growth.
  void stamp(Grid& grid) const;
  /// Lowers the clearance of coarse cells of this size [m] to the distance from that ground.
  void stamp(ClearanceWindow& window, double size) const;
  /// [m] by which a footprint comes closer than the growth; 0 = it does not.
  double depth(const Pose2& T_map_body, const FootprintSize& footprint) const;
  /// For a point; less than the growth, or even negative, is too close.
  FenceRoom room(const Eigen::Vector2d& p_map) const { return roomAt(fences_, p_map); }

 private:
  std::vector<Fence> fences_;
  double growth_ = 0.0;
};

/// A map's clearance combined with fences.
class FencedClearance : public ClearanceSource {
 public:
  /// Both must outlive this.
  FencedClearance(const ClearanceSource& map, const FencedGround& fenced)
      : map_(map), fenced_(fenced) {}

  double coarseSize() const override { return map_.coarseSize(); }
  std::optional<ClearanceWindow> bounds() const override { return map_.bounds(); }
  void fill(ClearanceWindow& window) const override {
    map_.fill(window);
    fenced_.stamp(window, coarseSize());
  }

 private:
  const ClearanceSource& map_;
  const FencedGround& fenced_;
};

}  // namespace tread::planner
