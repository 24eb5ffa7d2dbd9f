// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>

#include "common/grid/grid.hpp"
#include "modules/mapping/core/ground_map.hpp"
#include "modules/mapping/core/voxel_map.hpp"

namespace tread::mapping {

/// What counts as an obstacle for this robot.
struct ObstacleConfig {
  /// [m] above the ground: lower things are driven over; also below it: what is deeper is a drop.
  double step = 0.15;
  double robot_height = 0.0;  ///< [m] above the ground: higher things are driven under
};

/// Says what a column is, by heights above the ground of its voxels' centres.
/** With ground g, doubt u, and the band from g + step to g + robot_height:
 *  1. Obstacle: something occupied in the band, and above g + step + u.
 *  2. In doubt (occupied in the band, but no higher than g + step + u: perhaps the ground itself):
 *     free if the space above it in the band was seen free, else unknown. Driving nearer ends the
 *     doubt.
 *  3. Free: something in the band, widened by u, was seen free. Otherwise unknown.
 *  The ground is no higher than the lowest voxel that was seen: that lowers g by up to u and a
 *  cell. */
class ColumnClassifier {
 public:
  ColumnClassifier(const ObstacleConfig& config, double cell_size)
      : config_(config), cell_size_(cell_size) {}

  Cell classify(const Column& column, int lower_z, const GroundHeight& ground) const;
  /// Bit of the highest voxel that the ground occupies: below the band; -1 if none was seen.
  int surface(const Column& column, int lower_z, const GroundHeight& ground) const;
  /// Whether whoever drives from a column over the other's edge falls deeper than a step.
  bool isDrop(int surface, int neighbour) const {
    return surface >= 0 && (neighbour - surface - 1) * cell_size_ > config_.step;
  }

 private:
  uint64_t band(double from, double to, int lower_z) const;

  ObstacleConfig config_;
  double cell_size_;
};

}  // namespace tread::mapping
