// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <optional>

#include "common/geometry/se2.hpp"

namespace tread {

/// How long the robot keeps its speed after a zero command, learned from its own stops.
/** A stop that begins at 0.3 m/s or more is measured from its first zero command to standstill, as
 * distance over initial speed: this includes the delay of the motors, their brake and the ground.
 * One longer stop counts at once; shorter ones count only after five in a row, and never below
 * half of the value in the robot's file. So ground with less grip is known after its first stop,
 * and ground with more grip after five. */
class StoppingTime {
 public:
  explicit StoppingTime(double configured) : configured_(configured) {}

  /// Whether the command that acts from now [us] on is zero.
  void command(bool zero, int64_t now);
  /// A measured pose and speed [m/s]; NaN = not measured, ignored.
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
  std::optional<int64_t> zero_since_;  ///< [us]; set until the measurement of the stop has begun
  int64_t newest_ = INT64_MIN;         ///< [us]
  double speed_ = 0.0;                 ///< [m/s] measured last
  Pose2 pose_;                         ///< measured last
  std::optional<Stop> stop_;
  std::deque<double> samples_;  ///< [s]
  int64_t count_ = 0;
};

}  // namespace tread
