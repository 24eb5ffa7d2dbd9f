// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <functional>
#include <optional>
#include <string>

#include "modules/planner/core/map/distance_to_goal.hpp"

namespace tread::planner {

/// Decides which goal is valid: given after the arming, and vouched for by an operator who is
/// present.
/** A goal without an operator does not replace another one. A goal that has ended stays invalid:
 * its sender must give a new one. */
class GoalWatch {
 public:
  /// Whether an operator who is present vouches for a goal id now.
  using StoodFor = std::function<bool(int64_t goal_id)>;

  /// A goal was received at now [us]. False if it has ended before.
  bool take(const Goal& goal, int64_t now);
  /// The operator cancels the goal.
  void cancel();
  /// The robot has stopped by itself: it does not continue by itself.
  void lose(const Reason& why) {
    if (goal_) end(goal_, why);
  }
  /// Call in each step. `armed_since` [us]: since when the operator's permission has held.
  void update(int64_t now, std::optional<int64_t> armed_since, const StoodFor& stood_for);

  /// The valid goal, if any.
  const std::optional<Goal>& goal() const { return goal_; }
  /// Why the last goal has ended without being cancelled; none if it has not.
  const Reason& lost() const { return lost_; }

 private:
  static constexpr size_t kRemembered = 16;
  /// [us] for which a goal waits for its sender's OPERATOR
  static constexpr int64_t kWait = 1'000'000;

  bool hasEnded(int64_t id) const;
  void adopt(int64_t now, const StoodFor& stood_for);
  void end(std::optional<Goal>& goal, const Reason& why);

  std::optional<Goal> goal_;
  std::optional<Goal> candidate_;  ///< nobody has vouched for it yet
  int64_t given_ = 0;              ///< [us] when the goal first arrived
  int64_t candidate_given_ = 0;
  std::deque<int64_t> ended_;
  Reason lost_;
};

}  // namespace tread::planner
