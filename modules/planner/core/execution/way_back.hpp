// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>

#include "common/execution/execution_tracker.hpp"
#include "modules/planner/core/map/distance_to_goal.hpp"

namespace tread::planner {

/// Inputs of the return in one step.
struct LinkReading {
  int64_t now = 0;  ///< [us]
  std::optional<Pose2> T_map_body;
  double position_std = 0.0;  ///< [m] of the pose; NaN unknown
  bool good = false;          ///< the operator has seen the robot recently
  bool lost = false;          ///< the operator is silent without having released the lease
  bool armed = false;
};

/// Remembers the robot's path and where on it the link was good; once the operator is lost, gives
/// the place to return to.
/** First the last place with a good link, then, if there is still no operator, step by step back
 * along the path. The robot waits a few seconds before it sets off. A restored link, a disarmed
 * robot or a stop ends it: another loss restarts it. Pure: time is an argument. */
class WayBack {
 public:
  /// Call in each step. nullopt unless the robot should return.
  std::optional<Goal> update(const LinkReading& link);
  /// The robot stopped during the return: it stays where it is until an operator has been present.
  void giveUp(const std::string& why);
  /// For instance that the operator is lost and the robot returns; none without a loss.
  const Reason& state() const { return state_; }

 private:
  /// A place on the path with a good link.
  struct Place {
    Eigen::Vector2d p_map{0.0, 0.0};
    double std = 0.0;  ///< [m]
  };
  void remember(const LinkReading& link);
  bool uncertain(const LinkReading& link) const;
  void stepBack();
  std::optional<Goal> follow(const LinkReading& link);

  std::deque<Place> places_;  ///< oldest first
  std::optional<int64_t> good_since_;
  std::optional<int64_t> lost_since_;
  std::optional<int64_t> there_since_;  ///< [us] since when it is at the place to which it returned
  bool given_up_ = false;
  int64_t goal_id_ = 0;  ///< decreases: operators' goals are never negative
  Reason state_;
};

}  // namespace tread::planner
