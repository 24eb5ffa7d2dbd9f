// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/core/shock_learner.hpp"

#include <cmath>
#include <utility>

namespace tread::learner {
namespace {

constexpr double kKeptRadius = 25.0;  // of map [m]
/// Weight of a new segment in the estimate of the local ground, on a logarithmic scale.
constexpr double kHereGain = 0.6;
/// Smoother ground shakes no vehicle, and its measured roughness is mostly the range finder's noise
/// [m].
constexpr double kLeastSeen = 0.003;

}  // namespace

bool ShockLearner::takeTile(Tile tile, double cell_size, int tile_cells) {
  if (!(cell_size > 0.0) || tile_cells <= 0 ||
      tile.cells.size() != static_cast<size_t>(tile_cells) * static_cast<size_t>(tile_cells))
    return false;
  if (!map_ || map_->cellSize() != cell_size || map_->tileCells() != tile_cells)
    map_.emplace(cell_size, tile_cells);
  map_->put(std::move(tile));
  return true;
}

void ShockLearner::restart() {
  felt_.restart();
  map_.reset();
  here_ = std::numeric_limits<double>::quiet_NaN();
}

double ShockLearner::seenAlong(const std::vector<Eigen::Vector2d>& p_map) const {
  if (!map_) return 0.0;
  double squares = 0.0;
  int count = 0;
  for (const Eigen::Vector2d& p : p_map) {
    const CellIndex cell = Grid(map_->cellSize(), {}, 0, 0).indexOf(p);
    const Cell cost = map_->window(cell, 1, 1).at(cell);
    if (!isFree(cost) || cost == kFree) continue;
    squares += std::pow(roughnessOf(cost), 2);
    ++count;
  }
  return count > 0 ? std::sqrt(squares / count) : 0.0;
}

std::optional<FeltSegment> ShockLearner::take(const BodyMotion& motion) {
  std::optional<FeltSegment> segment = felt_.take(motion);
  if (!segment) return segment;
  // Cells under the robot are not observed any more: this is the earlier observation.
  const double seen = seenAlong(segment->p_map);
  if (seen >= kLeastSeen) regression_.learn(seen, segment->speed, segment->shock);
  const double felt = segment->shock / model().speedFactor(segment->speed);
  here_ = std::isfinite(here_) ? here_ * std::pow(felt / here_, kHereGain) : felt;
  if (map_) map_->forgetBeyond(motion.p_map, kKeptRadius);
  return segment;
}

}  // namespace tread::learner
