// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "common/geometry/se2.hpp"

namespace tread {

/// How long the robot goes on at its speed after a zero command, learned from its own stops.
/** A stop that begins at 0.3 m/s or more is measured from its first zero command to standstill, as
 * way over speed at its begin: delay of the motors, their brake and the ground are all in it. One
 * longer stop counts at once; shorter ones only when the last five say so, and never less than
 * half of what the robot's file says. So new ground that holds worse is known after its first stop,
 * and ground that holds better after five. */
class StoppingTime {
 public:
  explicit StoppingTime(double configured) : configured_(configured) {}

  /// Whether the command that holds from now [us] on is zero.
  void command(bool zero, int64_t now);
  /// A measured pose and speed [m/s]; NaN = unmeasured, which tells nothing.
  void measure(int64_t utime, const Pose2& T_map_body, double speed);

  double seconds() const;
  /// Stops that were measured.
  int64_t count() const { return count_; }

 private:
  struct Stop {
    double speed;  ///< [m/s] at its begin
    double way;    ///< [m] so far
    Pose2 last;
  };
  void end();

  double configured_;
  bool zero_ = true;
  std::optional<int64_t> zero_since_;  ///< [us]; until the stop has begun to be measured
  int64_t newest_ = INT64_MIN;         ///< [us]
  double speed_ = 0.0;                 ///< [m/s] measured last
  Pose2 pose_;                         ///< measured last
  std::optional<Stop> stop_;
  std::deque<double> samples_;  ///< [s]
  int64_t count_ = 0;
};

}  // namespace tread
