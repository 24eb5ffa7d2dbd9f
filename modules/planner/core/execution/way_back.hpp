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

/// What the way back depends on in one step.
struct LinkReading {
  int64_t now = 0;  ///< [us]
  std::optional<Pose2> T_map_body;
  double position_std = 0.0;  ///< [m] of the pose; NaN unknown
  bool good = false;          ///< the operator has seen the robot a moment ago
  bool lost = false;          ///< the operator has fallen silent without letting go
  bool armed = false;
};

/// Remembers the way that the robot came and where on it the link was good; once the operator is
/// lost, tells where to return to.
/** First to the last place with a good link, then, if nobody is heard there, step by step along the
 * way that it came. The robot stands for a few seconds before it sets off. A link that is back, a
 * robot that is not armed, and a stop end it: another loss begins anew. Pure: time is an argument.
 */
class WayBack {
 public:
  /// Call in each step. Nothing unless the robot shall return.
  std::optional<Goal> update(const LinkReading& link);
  /// The robot stopped on its way back: it stays where it is until an operator has been there.
  void giveUp(const std::string& why);
  /// For instance that the operator is lost and the robot returns; none if there was no loss.
  const Reason& state() const { return state_; }

 private:
  /// A place on the way with a good link.
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
  std::optional<int64_t> there_since_;  ///< [us] at the place that it returned to
  bool given_up_ = false;
  int64_t goal_id_ = 0;  ///< counts down: no operator's goal is negative
  Reason state_;
};

}  // namespace tread::planner
