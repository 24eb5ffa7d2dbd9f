// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include <Eigen/Core>

#include "common/grid/grid.hpp"
#include "modules/mapping/core/voxel_map.hpp"

namespace tread::mapping {

/// How a range finder's returns determine roughness.
struct RoughnessConfig {
  double range_noise = 0.0;  ///< [m] standard deviation of a range; 0 = no roughness
};

/// A return on the ground.
struct GroundPoint {
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();  ///< [m]
  double noise = 0.0;                               ///< variance of its height by range noise [m2]
};

/// Roughness of the ground, patch by patch, from scan lines across it.
/** 1. Consecutive returns of one sweep within a patch are a profile of its ground. A straight line
 *    is fitted; the residuals are bumps and range noise. An error of the pose moves the whole
 *    profile and changes nothing.
 *  2. A patch sums the squares of all its profiles, minus those expected from range noise. Of N
 *     returns the line takes two degrees of freedom.
 * Castelnovi, Arkin and Collins (ICRA 2005) also derive roughness from the spread of a downward
 * scan. */
class RoughnessMap {
 public:
  /// Cells per side of a patch.
  static constexpr int kPatchCells = 16;

  RoughnessMap(double cell_size, int side_cells);

  /// Moves the window; `lower` is its lower left cell, a multiple of kPatchCells.
  void moveTo(CellIndex lower);
  /// Takes the ground returns of one sweep in order. Returns the patches (index of the lower left
  /// cell) whose cost changed noticeably.
  std::vector<CellIndex> take(const std::vector<GroundPoint>& points);
  /// 1..100 of a cell of the window, see costOf(); kFree with too little data.
  Cell at(CellIndex cell) const { return patches_.at(patchOf(cell)).cost; }

 private:
  struct Patch {
    double squares = 0.0;  // of the residuals, minus the noise [m2]
    double degrees = 0.0;  // of freedom
    Cell cost = kFree;     // as last reported
  };

  static CellIndex patchOf(CellIndex cell) {
    return {floorDivide(cell.x, kPatchCells), floorDivide(cell.y, kPatchCells)};
  }
  CellIndex patchUnder(const GroundPoint& point) const;
  /// Takes the profile points[first..end) of a patch.
  void takeProfile(const std::vector<GroundPoint>& points, size_t first, size_t end, Patch& patch);

  double cell_size_;
  Window<Patch> patches_;
};

}  // namespace tread::mapping
