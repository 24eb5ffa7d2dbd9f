// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>

#include "modules/planner/core/execution/planner_inputs.hpp"

namespace tread::planner {

/// Knows when the vehicle has come to a stand: by its twist, or by its poses where no twist is
/// measured.
class StandstillDetector {
 public:
  /// Takes the newest pose; the same again is no news.
  void take(const PoseReading& pose);
  /// Whether the vehicle has stood for a moment, judged by poses measured after `since` [us] only.
  bool stands(int64_t since) const;

 private:
  static constexpr int64_t kMoment = 200'000;  ///< [us]
  static constexpr double kSlow = 0.08;        ///< [m/s, rad/s]

  std::deque<PoseReading> poses_;
};

/// Knows when the vehicle does not come nearer to its goal any more.
class ProgressMonitor {
 public:
  /// `patience` [us] without progress is too long.
  explicit ProgressMonitor(int64_t patience) : patience_(patience) {}

  void restart(int64_t now);
  /// Takes the way to go [m]. Returns true if there was no progress for too long, and begins anew.
  /** A way that has become much longer is a dead end that was seen: patience begins anew, but only
   * so often. */
  bool stuck(double way_to_go, int64_t now);

 private:
  static constexpr double kProgress = 0.5;  ///< [m]
  static constexpr double kDeadEnd = 3.0;   ///< [m]
  static constexpr int kDeadEnds = 10;

  int64_t patience_;
  int64_t since_ = 0;
  double best_ = 0.0;
  bool any_ = false;
  int dead_ends_ = 0;
};

}  // namespace tread::planner
