// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <limits>
#include <vector>

#include "common/grid/footprint.hpp"
#include "common/grid/grid.hpp"
#include "common/ground/shock_model.hpp"
#include "modules/planner/core/search/pattern_table.hpp"

namespace tread::planner {

/// What shock is worth against time.
struct ShockCostConfig {
  double weight = 0.0;    ///< [s] what a second of twice the harmless shock costs more; 0 = nothing
  double harmless = 0.3;  ///< [m/s2] shock (RMS) that costs nothing
};

/// What is known of shock at one moment.
struct ShockKnowledge {
  ShockModel model;
  double here = std::numeric_limits<double>::quiet_NaN();  ///< [m/s2] shock at 1 m/s where no
                                                           ///< roughness was seen
};

/// Ground that nobody saw is as rough as the nearest that somebody did: else it would be cheaper,
/// and ways would lead there.
/** Costs of free cells in rows of `width`; kFree, unknown, is replaced by the cost that is the
 * fewest steps away, at most `reach` of them. */
void spreadRoughness(std::vector<Cell>& costs, int width, int reach);
/// The same in a grid; what is not free stays as it is. `reach` in metres.
void spreadRoughness(Grid& grid, double reach);

/// Prices of the ground: how many seconds a second on it costs, by its roughness and the pattern.
/** Rate = weight x max(0, sqrt(E[shock^2]) / harmless - 1). The expectation holds what is
 * uncertain, so that unknown ground costs more than known ground of the same looks. */
class GroundCost {
 public:
  GroundCost(const ShockCostConfig& config, const ShockKnowledge& shock, const PatternTable& table);

  /// Extra cost of a pattern begun at a pose [s]: along its way, on the cells under the body
  /// origin.
  double cost(const Grid& grid, const TurnedPose& T_map_start, const TablePattern& pattern) const;
  /// Least cost of a metre on a cell of that cost over that on smooth ground, by the best pattern
  /// of steady driving ahead [1].
  const std::array<float, kCostMax + 1>& slowness() const { return slowness_; }

 private:
  using Rates = std::array<float, kCostMax + 1>;

  const TablePattern* first_;  ///< of the table: a pattern's rates have its place in it
  std::vector<Rates> rates_;   ///< [s/s] by pattern and cost of the cell
  Rates slowness_{};
};

}  // namespace tread::planner
