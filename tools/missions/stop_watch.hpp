// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/geometry/se2.hpp"

namespace tread::missions {

/// The robot came to rest between start and goal.
struct Stop {
  double time = 0.0;      ///< [s] since the start of the mission
  double duration = 0.0;  ///< [s] that it stood
  std::string reason;     ///< as it was published; empty = nobody had said why
};

/// What was published when the robot slowed down.
struct SaidReason {
  std::string planner;  ///< PLAN: its reason
  std::string bridge;   ///< EXECUTION: why the last one was aborted, if it was
};

/// Notes each time the true robot comes to rest after it has moved.
/** To rest is: slower than 5 cm/s and 0.05 rad/s for 0.2 s, so that joins through rest (a turn on
 * the spot, backing up) count, too. The reason is the planner's at the moment when it had become so
 * slow; where the planner says nothing, the bridge's. Before the first motion nothing is a stop. */
class StopWatch {
 public:
  /// Call every 50 ms of virtual time [us] with the true velocity.
  void step(int64_t utime, const Twist2& v_body, const SaidReason& said);

  /// All stops, times in [us] turned into [s] since `start`; the one that lasts is left out if
  /// `arrived`.
  std::vector<Stop> stops(int64_t start, bool arrived) const;
  /// [us] of the first motion; 0 = it never moved.
  int64_t begun() const { return begun_; }
  /// [s] for which it moved.
  double driven() const { return static_cast<double>(driven_) * 1e-6; }

 private:
  static constexpr int64_t kMoment = 200'000;  ///< [us]
  static constexpr double kSlow = 0.05;        ///< [m/s, rad/s]

  struct Rest {
    int64_t from = 0;
    int64_t to = 0;
    std::string reason;
  };

  std::vector<Rest> rests_;
  int64_t begun_ = 0;
  int64_t last_step_ = 0;
  int64_t driven_ = 0;
  bool slow_ = true;
  bool resting_ = false;  ///< the last of rests_ goes on
  Rest slowed_;           ///< since when it has been slow, and why
};

}  // namespace tread::missions
