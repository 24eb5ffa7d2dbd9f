// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "common/execution/stop_reason.hpp"
#include "common/fence/fence_book.hpp"
#include "modules/motor_bridge/core/motion_track.hpp"
#include "modules/motor_bridge/core/program.hpp"

namespace tread::motor {

/// What the robot needs to come to a stand.
struct FenceLimits {
  std::vector<Fence> own;      ///< the robot's own fences
  FootprintSize outline;       ///< of the body
  double stopping_time = 0.5;  ///< [s] at its speed that it goes on after a zero command
};

/// Sees to it that the outline stays within the fences, whoever commands.
/** For each step: the motions that may be under way (the measured twist, the newest command and the
 * fastest one of the last moments, with little and with much of their turn) go on for the age of
 * the pose and the stopping time. A speed that is not measured counts as full, but only the way the
 * tracks were commanded lately, so that the robot can be driven away and back in; a turn that is
 * not measured is as commanded. The outline, grown by two standard deviations of the position,
 * must not cross a fence on these ways. What is over a fence already may only come back: no way may
 * lead farther out than the farthest in it has been since it was last armed. */
class FenceWatch {
 public:
  FenceWatch(const FenceLimits& limits, const MotionLimits& motion)
      : limits_(limits), motion_(motion), book_(limits.own) {}

  FenceBook& book() { return book_; }
  const FenceBook& book() const { return book_; }
  /// A measurement with a pose.
  void receive(const InsMotion& ins);
  /// What MotionLimits::motion() makes of the command that holds from now [us] on.
  void command(const Command& motion, int64_t now);
  /// A person takes it from here: where it stands now counts.
  void restart() { best_.clear(); }
  /// [s] learned on the ground that the robot stands on.
  void setStoppingTime(double seconds) { limits_.stopping_time = seconds; }

  /// Which fence a zero now keeps it from crossing at now [us]; none = no fence.
  Reason fault(int64_t now);

 private:
  struct Given {
    int64_t utime;
    Command motion;
  };

  /// Poses that the motions under way may lead to.
  struct Ways {
    std::vector<Pose2> poses;
    double farthest = 0.0;  ///< [m] from here
  };

  /// Told for a second: arming is needed then, and a person who drives on without INS knows it.
  Reason blindness(int64_t now);
  /// [m/s] forward and to the left, as measured; else the full speed each way in which the robot
  /// was commanded lately, to the side where it can be.
  std::vector<Eigen::Vector2d> velocities(int64_t now) const;
  std::vector<Twist2> twists(int64_t now) const;
  Reason faultOfFence(const Fence& fence, double& best, const Ways& ways) const;

  FenceLimits limits_;
  MotionLimits motion_;
  FenceBook book_;
  InsMotion ins_;
  std::deque<Given> given_;       ///< of the last moments, oldest first
  std::optional<int64_t> ahead_;  ///< [us] when a track was last commanded forward
  std::optional<int64_t> back_;   ///< [us] ... backward
  std::optional<int64_t> left_;   ///< [us] when the robot was last commanded to the left
  std::optional<int64_t> right_;  ///< [us] ... to the right
  std::vector<double> best_;      ///< [m] by fence: most room since it was crossed
  int64_t best_revision_ = -1;
  std::optional<int64_t> blind_since_;  ///< [us]
};

}  // namespace tread::motor
