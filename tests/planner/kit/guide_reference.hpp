// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cmath>
#include <limits>
#include <queue>
#include <utility>
#include <vector>

#include "modules/planner/core/map/heading_aware_heuristic.hpp"

namespace tread::planner::testkit {

/// Reference for HeadingAwareHeuristic: Dijkstra over all squares and headings, without shortcuts.
/** Implemented from the description of the moves: each of 16 directions leads to one square,
 * adjacent or one further; the heading changes by at most one bin on the way, or by one on the
 * spot. */
class GuideReference {
 public:
  GuideReference(FreeConfigurations& configurations, const Goal& goal, const Pose2& start,
                 const MotionRates& rates)
      : configurations_(configurations), rates_(rates), start_(start) {
    cost_.assign(configurations.count() * kHeadings, std::numeric_limits<double>::infinity());
    seed(goal);
    while (!open_.empty()) {
      const auto [cost, state] = open_.top();
      open_.pop();
      if (cost <= cost_[state]) relax(cost, state);
    }
  }
  double at(int column, int row, int heading) const { return cost_[number(column, row, heading)]; }

 private:
  static constexpr int kHeadings = HeadingAwareHeuristic::kHeadings;
  static constexpr double kBin = 2.0 * kPi / kHeadings;
  using Entry = std::pair<double, size_t>;

  size_t number(int column, int row, int heading) const {
    return configurations_.number(column, row) * kHeadings + static_cast<size_t>(heading);
  }
  bool contains(int column, int row) const {
    return column >= 0 && row >= 0 && column < configurations_.width() &&
           row < configurations_.height();
  }
  void offer(double cost, size_t state) {
    if (cost >= cost_[state]) return;
    cost_[state] = cost;
    open_.push({cost, state});
  }
  void seed(const Goal& goal) {
    const Pose2& at = goal.T_map_goal;
    for (int row = 0; row < configurations_.height(); ++row) {
      for (int column = 0; column < configurations_.width(); ++column) {
        const bool own = column == configurations_.column(at.x) && row == configurations_.row(at.y);
        const double off = (configurations_.centre(column, row) - at.position()).norm();
        if (!own && off > goal.position_tolerance) continue;
        for (int heading = 0; heading < kHeadings; ++heading) {
          const double turn = std::abs(wrapAngle(heading * kBin - at.yaw));
          if (turn > std::max(goal.yaw_tolerance, kBin / 2.0)) continue;
          if (own || configurations_.isFree(configurations_.number(column, row), heading))
            offer(0.0, number(column, row, heading));
        }
      }
    }
  }
  /// Integer direction vectors in order: 1:0, 2:1, 1:1, 1:2 and so on.
  static std::pair<int, int> stepIn(int direction) {
    const double angle = direction * kBin;
    const int reach = direction % 2 == 0 ? 1 : 2;
    const double longest = std::max(std::abs(std::cos(angle)), std::abs(std::sin(angle)));
    return {static_cast<int>(std::lround(reach * std::cos(angle) / longest)),
            static_cast<int>(std::lround(reach * std::sin(angle) / longest))};
  }
  void relax(double cost, size_t state) {
    const auto square = static_cast<int>(state / kHeadings);
    const int heading = static_cast<int>(state % kHeadings);
    const int column = square % configurations_.stride() - FreeConfigurations::kRim;
    const int row = square / configurations_.stride() - FreeConfigurations::kRim;
    if (rates_.turn.any)
      for (const int turn : {-1, 1})
        from(column, row, heading + turn, cost + static_cast<double>(rates_.turn.cost(0.0, kBin)));
    for (int direction = 0; direction < kHeadings; ++direction) {
      const MotionRates::Rate& rate = rates_.along[static_cast<size_t>(direction)];
      if (!rate.any) continue;
      const auto [dx, dy] = stepIn((heading + direction) % kHeadings);
      if (!between(column, row, dx, dy)) continue;
      const double way = std::hypot(dx, dy) * configurations_.size();
      for (const int turn : {-1, 0, 1})
        if (turn == 0 || rate.turns)
          from(column - dx, row - dy, heading + turn,
               cost + static_cast<double>(rate.cost(way, std::abs(turn) * kBin)));
    }
  }
  /// A long step passes two squares, and one of them must be passable.
  bool between(int column, int row, int dx, int dy) const {
    if (std::abs(dx) + std::abs(dy) <= 2) return true;
    const int straight_x = std::abs(dx) == 2 ? dx / 2 : 0;
    const int straight_y = std::abs(dy) == 2 ? dy / 2 : 0;
    const int corner_x = dx > 0 ? 1 : -1;
    const int corner_y = dy > 0 ? 1 : -1;
    return configurations_.passable(
               configurations_.number(column - straight_x, row - straight_y)) ||
           configurations_.passable(configurations_.number(column - corner_x, row - corner_y));
  }
  void from(int column, int row, int heading, double cost) {
    if (!contains(column, row)) return;
    heading = (heading + kHeadings) % kHeadings;
    const int own = static_cast<int>(std::lround(start_.yaw / kBin) + kHeadings) % kHeadings;
    const bool is_start = column == configurations_.column(start_.x) &&
                          row == configurations_.row(start_.y) && heading == own;
    if (is_start || configurations_.isFree(configurations_.number(column, row), heading))
      offer(cost, number(column, row, heading));
  }

  FreeConfigurations& configurations_;
  const MotionRates& rates_;
  Pose2 start_;
  std::vector<double> cost_;
  std::priority_queue<Entry, std::vector<Entry>, std::greater<>> open_;
};

}  // namespace tread::planner::testkit
