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

/// Trade-off between shock and time.
struct ShockCostConfig {
  double weight = 0.0;    ///< [s] extra cost of a second at twice the harmless shock; 0 = none
  double harmless = 0.3;  ///< [m/s2] shock (RMS) that costs nothing
};

/// The estimate of shock at one instant.
struct ShockKnowledge {
  ShockModel model;
  double here = std::numeric_limits<double>::quiet_NaN();  ///< [m/s2] shock at 1 m/s where no
                                                           ///< roughness was observed
};

/// Unobserved ground gets the roughness of the nearest observed ground: otherwise it would be
/// cheaper, and paths would lead there.
/** Costs of free cells in rows of `width`; kFree, unknown, is replaced by the nearest known cost,
 * at most `reach` steps away. */
void spreadRoughness(std::vector<Cell>& costs, int width, int reach);
/// The same in a grid; other cells are unchanged. `reach` in metres.
void spreadRoughness(Grid& grid, double reach);

/// Cost of the ground: extra seconds per second on it, by its roughness and the pattern.
/** Rate = weight x max(0, sqrt(E[shock^2]) / harmless - 1). The expectation includes the
 * uncertainty, so that unknown ground costs more than known ground of the same appearance. */
class GroundCost {
 public:
  GroundCost(const ShockCostConfig& config, const ShockKnowledge& shock, const PatternTable& table);

  /// Extra cost of a pattern started at a pose [s]: along its path, on the cells under the body
  /// origin.
  double cost(const Grid& grid, const TurnedPose& T_map_start, const TablePattern& pattern) const;
  /// Least cost of a metre on a cell of this cost relative to smooth ground, by the best pattern of
  /// steady forward driving [1].
  const std::array<float, kCostMax + 1>& slowness() const { return slowness_; }

 private:
  using Rates = std::array<float, kCostMax + 1>;

  const TablePattern* first_;  ///< of the table: a pattern's offset from it indexes its rates
  std::vector<Rates> rates_;   ///< [s/s] by pattern and cost of the cell
  Rates slowness_{};
};

}  // namespace tread::planner
