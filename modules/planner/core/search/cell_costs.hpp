// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <vector>

#include "common/grid/grid.hpp"

namespace tread::planner {

/// Costs of cells for a point that drives over their centres, as SBPL's lattice environments have
/// them.
/** With them the search is SBPL's: a pattern costs its own cost times one more than the greatest
 * cost of the cells that it passes. Cells begin at (0, 0). */
class CellCosts {
 public:
  /// `costs` row by row from y = 0, x fastest. `blocked_from`: cells that cost so much are blocked.
  CellCosts(int width, int height, std::vector<uint8_t> costs, int blocked_from)
      : width_(width), height_(height), costs_(std::move(costs)), blocked_from_(blocked_from) {}

  /// Cost of a cell; -1 where it is blocked or outside.
  int at(CellIndex cell) const {
    if (cell.x < 0 || cell.y < 0 || cell.x >= width_ || cell.y >= height_) return -1;
    const int cost = costs_[static_cast<size_t>(cell.y) * static_cast<size_t>(width_) +
                            static_cast<size_t>(cell.x)];
    return cost >= blocked_from_ ? -1 : cost;
  }
  /// Greatest cost of the cells at these offsets from a cell; -1 if one of them is blocked.
  int worst(CellIndex from, const std::vector<CellIndex>& offsets) const {
    int worst = at(from);
    for (const CellIndex& offset : offsets) {
      const int cost = at({from.x + offset.x, from.y + offset.y});
      if (cost < 0 || worst < 0) return -1;
      worst = std::max(worst, cost);
    }
    return worst;
  }

 private:
  int width_;
  int height_;
  std::vector<uint8_t> costs_;
  int blocked_from_;
};

}  // namespace tread::planner
