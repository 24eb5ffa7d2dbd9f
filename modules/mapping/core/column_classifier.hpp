// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>

#include "common/grid/grid.hpp"
#include "modules/mapping/core/ground_map.hpp"
#include "modules/mapping/core/voxel_map.hpp"

namespace tread::mapping {

/// Definition of an obstacle for this robot.
struct ObstacleConfig {
  /// [m] above the ground: lower objects are driven over; also below it: a larger depth is a drop.
  double step = 0.15;
  double robot_height = 0.0;  ///< [m] above the ground: the robot drives under higher objects
};

/// Classifies a column, by heights of its voxels' centres above the ground.
/** With ground g, uncertainty u, and the band from g + step to g + robot_height:
 *  1. Obstacle: something occupied in the band, and above g + step + u.
 *  2. Uncertain (occupied in the band, but no higher than g + step + u: possibly the ground
 *     itself): free if the space above it in the band was observed free, else unknown. Driving
 *     closer resolves it.
 *  3. Free: something in the band, widened by u, was observed free. Otherwise unknown.
 * The ground is no higher than the lowest observed voxel: that lowers g by up to u and a cell. */
class ColumnClassifier {
 public:
  ColumnClassifier(const ObstacleConfig& config, double cell_size)
      : config_(config), cell_size_(cell_size) {}

  Cell classify(const Column& column, int lower_z, const GroundHeight& ground) const;
  /// Bit of the highest voxel occupied by ground, below the band; -1 if none was observed.
  int surface(const Column& column, int lower_z, const GroundHeight& ground) const;
  /// Whether driving from a column over the other's edge means a fall deeper than a step.
  bool isDrop(int surface, int neighbour) const {
    return surface >= 0 && (neighbour - surface - 1) * cell_size_ > config_.step;
  }

 private:
  uint64_t band(double from, double to, int lower_z) const;

  ObstacleConfig config_;
  double cell_size_;
};

}  // namespace tread::mapping
