// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cmath>
#include <vector>

#include "common/geometry/se2.hpp"
#include "common/grid/clearance.hpp"

namespace tread {

/// A pose with the sine and cosine of its yaw precomputed.
struct TurnedPose {
  double x = 0.0;  ///< [m]
  double y = 0.0;  ///< [m]
  double cos_yaw = 1.0;
  double sin_yaw = 0.0;
};

inline TurnedPose turned(const Pose2& pose) {
  return {pose.x, pose.y, std::cos(pose.yaw), std::sin(pose.yaw)};
}

/// Oriented rectangular footprint in the body frame [m], with the discs that cover it.
class Footprint {
 public:
  /// `margin` [m] is added on all sides. Throws std::invalid_argument unless it has a positive
  /// length and width.
  Footprint(const FootprintSize& size, double margin);

  /// With the margin.
  const FootprintSize& size() const { return size_; }
  /// Radius of the smallest disc around the body origin that contains it [m].
  double circumscribed() const { return circumscribed_; }

  /// Whether the footprint at a pose overlaps no blocked cell: discs on the clearance field first,
  /// exact cells last.
  /** Exact: a cell is blocked over its whole area, and touching its border is no overlap; unknown
   * cells and everything outside the grid block as in the field. False for a pose that is not
   * finite. */
  bool isFree(const ClearanceField& clearance, const TurnedPose& T_map_body) const;
  /// Cells (of the grid's lattice, also outside its window) that the footprint at a pose overlaps,
  /// row by row.
  std::vector<CellIndex> cells(const Grid& grid, const Pose2& T_map_body) const;
  /// Number of blocked cells under the footprint: for escaping from a start in collision.
  int blockedCells(const Grid& grid, const Pose2& T_map_body, bool unknown_blocks) const;

 private:
  using Verdict = ClearanceField::Verdict;

  /// What the disc test leaves undecided.
  struct Unsure {
    bool blocked = false;  // certainly overlaps something
    double rear = 1e9;     // else the part along x that may overlap something [m], empty if none
    double front = -1e9;
  };

  Unsure judgeByDiscs(const ClearanceField& clearance, const TurnedPose& T_map_body) const;

  FootprintSize size_;
  double circumscribed_;
  std::vector<double> disc_x_;  // centres of the covering discs along the body's x axis
  double half_step_;            // [m] half the distance between them
  float circumscribed_up_;  // around the body origin, rounded up to be conservative, as the others
  float inscribed_;
  float disc_radius_;
  float inscribed_radius_;  // discs of this radius around the same centres lie inside the footprint
};

}  // namespace tread
