// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include <Eigen/Core>

#include "common/grid/grid.hpp"
#include "modules/mapping/core/voxel_map.hpp"

namespace tread::mapping {

/// How a range finder's returns become roughness.
struct RoughnessConfig {
  double range_noise = 0.0;  ///< [m] standard deviation of a range; 0 = roughness is not looked at
};

/// A return on the ground.
struct GroundPoint {
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();  ///< [m]
  double noise = 0.0;                               ///< variance of its height by range noise [m2]
};

/// Roughness of the ground, patch by patch, from lines of returns across it.
/** 1. The returns of one sweep that follow each other within a patch are a profile of its ground. A
 *     straight line is fitted; what is left is bumps and range noise. A pose that is wrong moves
 * the whole profile and changes nothing.
 *  2. A patch adds up the squares of all its profiles, less what range noise is expected to give.
 *     Of N returns two are used up by the line.
 * Castelnovi, Arkin and Collins (ICRA 2005) take the spread of a downward scan for roughness, too.
 */
class RoughnessMap {
 public:
  /// Cells per side of a patch.
  static constexpr int kPatchCells = 16;

  RoughnessMap(double cell_size, int side_cells);

  /// Moves the window; `lower` is its lower left cell, a multiple of kPatchCells.
  void moveTo(CellIndex lower);
  /// Takes the ground returns of one sweep in their order. Returns the patches (index of the lower
  /// left cell) whose cost changed noticeably.
  std::vector<CellIndex> take(const std::vector<GroundPoint>& points);
  /// 1..100 of a cell of the window, see costOf(); kFree where too little was seen.
  Cell at(CellIndex cell) const { return patches_.at(patchOf(cell)).cost; }

 private:
  struct Patch {
    double squares = 0.0;  // of what the lines leave, less the noise [m2]
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
