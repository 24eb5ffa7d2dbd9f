// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <limits>
#include <optional>

#include "common/grid/grid.hpp"
#include "common/ground/shock_model.hpp"
#include "modules/learner/core/felt_shock.hpp"

namespace tread::learner {

/// Learns shock on a segment from the roughness that the range finder measured there before.
class ShockLearner {
 public:
  /// `arm` [m] from the body origin to the front end.
  explicit ShockLearner(double arm) : felt_(arm) {}

  /// Takes a tile of the map; false if it is malformed.
  bool takeTile(Tile tile, double cell_size, int tile_cells);
  /// Takes a measurement; returns the segment that it completes and that was learned from, if any.
  std::optional<FeltSegment> take(const BodyMotion& motion);
  /// The INS jumped: neither the current segment nor the map is valid any more.
  void restart();

  ShockModel model() const { return regression_.model(); }
  const ShockRegression& regression() const { return regression_; }
  void resume(const ShockRegression& regression) { regression_ = regression; }
  int pairs() const { return regression_.pairs(); }
  /// Shock of the ground of the last metres, converted to 1 m/s [m/s2]; NaN before the first
  /// segment.
  double here() const { return here_; }
  /// RMS roughness observed along a path [m]; 0 where none was observed.
  double seenAlong(const std::vector<Eigen::Vector2d>& p_map) const;

 private:
  FeltShock felt_;
  ShockRegression regression_;
  std::optional<TileMap> map_;
  double here_ = std::numeric_limits<double>::quiet_NaN();
};

}  // namespace tread::learner
