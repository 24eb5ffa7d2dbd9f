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

/// Data for predicting a stop.
struct FenceLimits {
  std::vector<Fence> own;      ///< the robot's own fences
  FootprintSize outline;       ///< of the body
  double stopping_time = 0.5;  ///< [s] at its speed that it continues after a zero command
};

/// Keeps the outline within the fences, whatever the source of commands.
/** In each step: the possible motions (the measured twist, the newest command and the fastest
 * recent one, with little and with much of their turn) continue for the age of the pose and the
 * stopping time. A speed that is not measured counts as full speed, but only in the directions in
 * which the tracks were commanded recently, so that the robot can be driven away and back in; a
 * turn that is not measured is as commanded. The outline, enlarged by two standard deviations of
 * the position, must not cross a fence on these paths. What is already beyond a fence may only
 * come back: no path may lead farther out than the robot was at its innermost position since it
 * was last armed. */
class FenceWatch {
 public:
  FenceWatch(const FenceLimits& limits, const MotionLimits& motion)
      : limits_(limits), motion_(motion), book_(limits.own) {}

  FenceBook& book() { return book_; }
  const FenceBook& book() const { return book_; }
  /// A measurement with a pose.
  void receive(const InsMotion& ins);
  /// Result of MotionLimits::motion() for the command that acts from now [us] on.
  void command(const Command& motion, int64_t now);
  /// A person takes over: the present position becomes the reference.
  void restart() { best_.clear(); }
  /// [s] learned on the present ground.
  void setStoppingTime(double seconds) { limits_.stopping_time = seconds; }

  /// The fence that only zero, given now [us], keeps it from crossing; no reason = none.
  Reason fault(int64_t now);

 private:
  /// Poses that the possible motions lead to.
  struct Ways {
    std::vector<Pose2> poses;
    double farthest = 0.0;  ///< [m] from here
  };

  /// Reported for a second: then arming is required, and a person who drives on without INS knows
  /// about it.
  Reason blindness(int64_t now);
  /// [m/s] forward and to the left, as measured; otherwise full speed in each direction in which
  /// the robot was recently commanded, sideways if it can.
  std::vector<Eigen::Vector2d> velocities(int64_t now) const;
  std::vector<Twist2> twists(int64_t now) const;
  Reason faultOfFence(const Fence& fence, double& best, const Ways& ways) const;

  FenceLimits limits_;
  MotionLimits motion_;
  FenceBook book_;
  InsMotion ins_;
  std::deque<TimedCommand> given_;  ///< the most recent ones, oldest first
  std::optional<int64_t> ahead_;    ///< [us] when a track was last commanded forward
  std::optional<int64_t> back_;     ///< [us] ... backward
  std::optional<int64_t> left_;     ///< [us] when the robot was last commanded to the left
  std::optional<int64_t> right_;    ///< [us] ... to the right
  std::vector<double> best_;        ///< [m] by fence: largest clearance since it was crossed
  int64_t best_revision_ = -1;
  std::optional<int64_t> blind_since_;  ///< [us]
};

}  // namespace tread::motor
