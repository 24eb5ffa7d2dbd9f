// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

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
 * the pose and the stopping time. The outline, grown by two standard deviations of the position,
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
  /// The command that holds from now [us] on, in the unit of the drive.
  void command(const TrackCommand& command, int64_t now);
  /// A person takes it from here: where it stands now counts.
  void restart() { best_.clear(); }
  /// [s] learned on the ground that the robot stands on.
  void setStoppingTime(double seconds) { limits_.stopping_time = seconds; }

  /// Which fence a zero now keeps it from crossing at now [us], in words; empty = none.
  std::string fault(int64_t now);

 private:
  struct Given {
    int64_t utime;
    TrackCommand command;
  };

  /// Told for a second: arming is needed then, and a person who drives on without INS knows it.
  std::string blindness(int64_t now);
  std::vector<Twist2> twists() const;
  std::string faultOfFence(const Fence& fence, double& best, const std::vector<Pose2>& ways) const;

  FenceLimits limits_;
  MotionLimits motion_;
  FenceBook book_;
  InsMotion ins_;
  std::deque<Given> given_;   ///< of the last moments, oldest first
  std::vector<double> best_;  ///< [m] by fence: most room since it was crossed
  int64_t best_revision_ = -1;
  std::optional<int64_t> blind_since_;  ///< [us]
};

}  // namespace tread::motor
