// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/core/map/ground_cost.hpp"

#include <algorithm>
#include <cmath>

namespace tread::planner {
namespace {

/// A pattern with a shorter path turns rather than drives [m].
constexpr double kLeastLength = 0.2;

/// Rate on a cell; where no roughness was observed, that of the local ground is assumed.
float rateOf(const ShockCostConfig& config, const ShockKnowledge& shock, Cell cell, double speed) {
  if (cell == kFree && !std::isfinite(shock.here)) return 0.0F;
  const double square = cell == kFree ? shock.model.meanSquareLike(shock.here, speed)
                                      : shock.model.meanSquare(roughnessOf(cell), speed);
  const double ratio = std::sqrt(square) / config.harmless;
  return static_cast<float>(config.weight * std::max(0.0, ratio - 1.0));
}

}  // namespace

void spreadRoughness(std::vector<Cell>& costs, int width, int reach) {
  const auto columns = static_cast<size_t>(width);
  std::vector<int> steps(costs.size());
  for (size_t i = 0; i < costs.size(); ++i) steps[i] = costs[i] == kFree ? reach + 1 : 0;
  const auto takeFrom = [&](size_t to, size_t from) {
    if (steps[from] + 1 >= steps[to]) return;
    steps[to] = steps[from] + 1;
    costs[to] = costs[from];
  };
  // From lower left to upper right, and back.
  for (size_t i = 0; i < costs.size(); ++i) {
    if (i % columns > 0) takeFrom(i, i - 1);
    if (i >= columns) takeFrom(i, i - columns);
  }
  for (size_t i = costs.size(); i-- > 0;) {
    if (i % columns + 1 < columns) takeFrom(i, i + 1);
    if (i + columns < costs.size()) takeFrom(i, i + columns);
  }
}

void spreadRoughness(Grid& grid, double reach) {
  std::vector<Cell> costs = grid.cells();
  for (Cell& cell : costs)
    if (!isFree(cell)) cell = kFree;
  spreadRoughness(costs, grid.width(), static_cast<int>(reach / grid.cellSize()));
  for (size_t i = 0; i < costs.size(); ++i)
    if (grid.cells()[i] == kFree) grid.cells()[i] = costs[i];
}

GroundCost::GroundCost(const ShockCostConfig& config, const ShockKnowledge& shock,
                       const PatternTable& table)
    : first_(table.patterns().data()), rates_(table.patterns().size()) {
  slowness_.fill(std::numeric_limits<float>::infinity());
  for (size_t i = 0; i < rates_.size(); ++i) {
    const TablePattern& pattern = table.patterns()[i];
    const double speed = pattern.length / pattern.duration;
    for (int cell = 0; cell <= kCostMax; ++cell) {
      if (pattern.length < kLeastLength) continue;
      float& rate = rates_[i][static_cast<size_t>(cell)];
      rate = rateOf(config, shock, static_cast<Cell>(cell), speed);
      if (pattern.reverses || pattern.entry != pattern.exit || pattern.exit == table.restClass())
        continue;
      float& slowness = slowness_[static_cast<size_t>(cell)];
      slowness = std::min(slowness, (1.0F + rate) * static_cast<float>(table.bestSpeed() / speed));
    }
  }
  // Shock felt here is uninformative about distant ground.
  slowness_[kFree] = 1.0F;
}

double GroundCost::cost(const Grid& grid, const TurnedPose& start,
                        const TablePattern& pattern) const {
  const Rates& rates = rates_[static_cast<size_t>(&pattern - first_)];
  double cost = 0.0, before = 0.0;
  for (const CheckedPose& pose : pattern.swept_footprint.poses) {
    const Pose2& at = pose.at.pose;
    const Cell cell =
        grid.at(grid.indexOf({start.x + start.cos_yaw * at.x - start.sin_yaw * at.y,
                              start.y + start.sin_yaw * at.x + start.cos_yaw * at.y}));
    cost += static_cast<double>(rates[isFree(cell) ? cell : kFree]) * (pose.at.time - before);
    before = pose.at.time;
  }
  return cost;
}

}  // namespace tread::planner
