// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "common/grid/grid.hpp"

namespace tread {

/// Oriented rectangular footprint in the body frame [m], with the discs that cover it.
class Footprint {
 public:
  /// Reaches from -rear to +front along x and half_width to both sides; `margin` is added on all sides.
  Footprint(double front, double rear, double half_width, double margin);

  double front() const { return front_; }
  double rear() const { return rear_; }
  double halfWidth() const { return half_width_; }
  /// Radius of the smallest disc around the body origin that contains it.
  double circumscribed() const;

  /// Whether the footprint at a pose overlaps no blocked cell: discs on the clearance field first, exact cells last.
  /** Exact: a cell is blocked over its whole area; unknown cells block if `unknown_blocks` (as in the field). */
  bool isFree(const Grid& grid, const ClearanceField& clearance, const Pose2& T_map_body,
              bool unknown_blocks) const;
  /// Cells (of the grid's lattice) that the footprint at a pose overlaps.
  std::vector<CellIndex> cells(const Grid& grid, const Pose2& T_map_body) const;
  /// Number of blocked cells under the footprint: for escaping from a start in collision.
  int blockedCells(const Grid& grid, const Pose2& T_map_body, bool unknown_blocks) const;

 private:
  double front_;
  double rear_;
  double half_width_;
  std::vector<double> disc_x_;  // centres of the covering discs along the body's x axis
  double disc_radius_;
};

}  // namespace tread
