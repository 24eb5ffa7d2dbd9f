// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "common/fence/fence.hpp"
#include "common/grid/grid.hpp"
#include "modules/planner/core/map/distance_to_goal.hpp"

namespace tread::planner {

/// Ground that fences forbid, and so much around it as plans must not come nearer than.
class FencedGround {
 public:
  FencedGround() = default;
  /// `growth` [m]: what the robot needs to stop, and what its position may be off by.
  FencedGround(std::vector<Fence> fences, double growth)
      : fences_(std::move(fences)), growth_(growth) {}

  bool empty() const { return fences_.empty(); }
  double growth() const { return growth_; }
  const std::vector<Fence>& fences() const { return fences_; }

  /// Makes obstacles of all cells that come nearer to forbidden ground than the growth.
  void stamp(Grid& grid) const;
  /// Lowers the clearance of coarse cells of this side [m] to the distance from that ground.
  void stamp(ClearanceWindow& window, double size) const;
  /// [m] by which a footprint comes nearer than the growth; 0 = it does not.
  double depth(const Pose2& T_map_body, const FootprintSize& footprint) const;
  /// From a point; less than the growth, or even negative, is too near.
  FenceRoom room(const Eigen::Vector2d& p_map) const { return roomAt(fences_, p_map); }

 private:
  std::vector<Fence> fences_;
  double growth_ = 0.0;
};

/// A map's clearance with fences in it.
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
