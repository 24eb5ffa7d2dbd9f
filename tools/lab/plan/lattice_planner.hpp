// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cstdint>
#include <utility>
#include <vector>

#include "modules/planner/core/search/path_planner.hpp"
#include "tools/lab/plan/primitives.hpp"

// SBPL's lattice problem for our search (SBPL: environment_navxythetalat, BSD).
namespace tread::plan {

/// Cell costs for a point that passes through cell centres.
/** Cells begin at (0, 0). */
class CellCosts {
 public:
  /// `costs` row by row from y = 0, x fastest. Cells with a cost of at least `blocked_from` are
  /// blocked.
  CellCosts(int width, int height, std::vector<uint8_t> costs, int blocked_from)
      : width_(width), height_(height), costs_(std::move(costs)), blocked_from_(blocked_from) {}

  /// Cost of a cell; -1 if it is blocked or outside.
  int at(CellIndex cell) const {
    if (cell.x < 0 || cell.y < 0 || cell.x >= width_ || cell.y >= height_) return -1;
    const int cost = costs_[static_cast<size_t>(cell.y) * static_cast<size_t>(width_) +
                            static_cast<size_t>(cell.x)];
    return cost >= blocked_from_ ? -1 : cost;
  }
  /// Largest cost of the cells at these offsets from a cell; -1 if one of them is blocked.
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

/// SBPL's rules: a primitive starts only in its heading bin, and costs its own cost times one plus
/// the largest cost of the cells that it passes.
class LatticeRules : public planner::EdgeRules {
 public:
  LatticeRules(CellCosts costs, double cell_size, std::vector<SearchPrimitive> primitives)
      : costs_(std::move(costs)), per_cell_(1.0 / cell_size), primitives_(std::move(primitives)) {}

  bool mayBegin(const planner::TablePattern& pattern, int heading_bin) const override {
    return primitives_[static_cast<size_t>(pattern.id())].start_bin == heading_bin;
  }
  float cost(double x, double y, const planner::TablePattern& pattern) const override;
  /// Whether the cell at a point [m] may be driven on.
  bool isFree(const Eigen::Vector2d& p) const { return costs_.at(cellAt(p.x(), p.y())) >= 0; }

 private:
  CellIndex cellAt(double x, double y) const;

  CellCosts costs_;
  double per_cell_;
  std::vector<SearchPrimitive> primitives_;  // by id
};

/// Finds the cheapest plan for a point on SBPL's lattice; the goal is one cell and one heading.
class LatticePlanner {
 public:
  /// `bins`: headings of the lattice. The id of a primitive is its index.
  LatticePlanner(const CellCosts& costs, double cell_size, int bins,
                 const std::vector<SearchPrimitive>& primitives);

  /// "Unreachable" is certain: all states of the lattice were expanded.
  planner::PathAnswer answer(const planner::PathQuery& query, const planner::StopPredicate& stop,
                             const planner::PathEvents& events = {});
  const planner::PatternSearch& search() const { return search_; }
  const planner::PatternTable& patterns() const { return patterns_; }

 private:
  void placeOnLattice(planner::SearchProblem& problem) const;

  double cell_size_;
  planner::PatternTable patterns_;
  LatticeRules rules_;
  planner::PatternSearch search_;
};

}  // namespace tread::plan
