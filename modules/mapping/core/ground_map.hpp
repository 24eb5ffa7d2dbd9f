// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <vector>

#include <Eigen/Geometry>

#include "common/grid/grid.hpp"
#include "modules/mapping/core/voxel_map.hpp"

namespace tread::mapping {

/// Uncertainty of the distant ground, given the robot's own stance.
struct GroundMapConfig {
  double height_noise = 0.03;  ///< [m] of the ground under the robot
  double slope_noise = 0.03;   ///< [1] of the robot's inclination relative to the ground's: bumps
  double curvature = 0.04;     ///< [1/m] change of the ground's slope with distance
  double slope_doubt = 0.03;   ///< [1] error of the ground per metre of distance, as observed by
};

/// The plane on which the robot stands.
struct GroundPlane {
  Eigen::Vector3d p_map = Eigen::Vector3d::Zero();  ///< body origin, on the ground [m]
  Eigen::Vector2d slope = Eigen::Vector2d::Zero();  ///< dz/dx, dz/dy in map [1]
};

/// The plane under a body; nullopt if it lies on its side.
std::optional<GroundPlane> planeUnder(const Eigen::Isometry3d& T_map_body);

/// Estimated height of the ground.
struct GroundHeight {
  double z = 0.0;      ///< [m] in map
  double doubt = 0.0;  ///< [m] possible error
};

/// Local ground, patch by patch, extrapolated from the robot's stances.
/** The robot stands on the ground, so each stance gives a plane whose accuracy decreases with
 * distance: its variance at distance d is height_noise^2 + (slope_noise d)^2 + (curvature d^2 /
 * 2)^2. A patch is the weighted mean of all planes extrapolated to it. So the estimate follows the
 * newest stance near the robot and hardly changes far ahead when it pitches on a bump, and a patch
 * that was driven over keeps its height. */
class GroundMap {
 public:
  /// Cells per side of a patch.
  static constexpr int kPatchCells = 8;

  GroundMap(const GroundMapConfig& config, double cell_size, int side_cells);

  /// Moves the window; `lower` is its lower left cell, a multiple of kPatchCells.
  void moveTo(CellIndex lower);
  /// Adds a stance. Returns the patches (index of the lower left cell) whose ground moved
  /// noticeably.
  std::vector<CellIndex> learn(const GroundPlane& plane);
  /// Ground at the centre of a cell of the window.
  GroundHeight at(CellIndex cell) const;

 private:
  struct Patch {
    double z = 0.0;  // at the centre of the patch
    Eigen::Vector2d slope = Eigen::Vector2d::Zero();
    double weight = 0.0;
    double nearest = 1e9;  // distance to the nearest stance [m]
    double told_z = 1e9;   // height last reported as moved
    double told_nearest = 1e9;
  };

  Eigen::Vector2d centreOf(CellIndex patch) const;
  bool refine(Patch& patch, const Eigen::Vector2d& centre, const GroundPlane& plane) const;

  GroundMapConfig config_;
  double cell_size_;
  Window<Patch> patches_;
};

}  // namespace tread::mapping
