// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <limits>

#include "modules/planner/core/search/search_problem.hpp"

namespace tread::planner {

constexpr float kNever = std::numeric_limits<float>::infinity();

/// An angle within half a turn [rad].
inline float wrapped(float yaw) {
  constexpr auto pi = static_cast<float>(kPi);
  while (yaw > pi) yaw -= 2.0F * pi;
  while (yaw < -pi) yaw += 2.0F * pi;
  return yaw;
}

/// What drives one search of an anytime run.
struct SearchWeights {
  float heuristic = 1.0F;
  float turn = 0.0F;

  bool exact() const { return heuristic <= 1.0F && turn <= 0.0F; }
};

/// What a step of a plan costs, and what is left from a node to the goal. A new cost term goes
/// here.
class CostModel {
 public:
  /// Cost from a node to the goal [s].
  struct Heuristic {
    float admissible;  ///< never more than the true cost
    float inflated;    ///< orders the open list
  };

  CostModel() = default;
  /// `problem` must outlive this.
  CostModel(const SearchConfig& config, const SearchProblem& problem);
  void setWeights(const SearchWeights& weights) { weights_ = weights; }
  const SearchWeights& weights() const { return weights_; }
  /// [m/s] of the fastest pattern.
  double bestSpeed() const { return speed_; }

  /// Cost of a pattern from a node to the node where it ends, without switchPenalty().
  float edgeCost(const SearchNode& parent, const TablePattern& pattern,
                 const SearchNode& end) const;
  bool staysOnPlan(const SearchNode& parent, const TablePattern& pattern) const;
  /// For leaving the committed plan; less the later it is left.
  float switchPenalty(const SearchNode& parent, const TablePattern& pattern) const;
  /// `on_blocked_ground`: whoever leaves it may go straight to the goal.
  Heuristic heuristic(const SearchNode& node, bool on_blocked_ground) const;

 private:
  SearchConfig config_;
  const SearchProblem* problem_ = nullptr;
  SearchWeights weights_;
  double speed_ = 1.0;
  float goal_yaw_ = 0.0F;
  float yaw_tolerance_ = 0.0F;
  float metre_cost_[2] = {0.0F, 0.0F};   // [s/m] see PatternTable::leastCosts()
  float radian_cost_[2] = {0.0F, 0.0F};  // [s/rad]
  float admissible_share_ = 1.0F;        // of the distance to the goal
  float distance_share_ = 1.0F;          // of it that the inflated heuristic counts
  float slack_ = 0.0F;                   // [m] by which the distance may be too long
};

}  // namespace tread::planner
