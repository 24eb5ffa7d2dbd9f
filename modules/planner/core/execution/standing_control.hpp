// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <vector>

#include "modules/planner/core/execution/moving_control.hpp"
#include "modules/planner/core/map/collision_checker.hpp"
#include "modules/planner/core/search/pattern_table.hpp"

namespace tread::planner {

/// Detects standstill by the vehicle's twist or, if it is not measured, by its poses.
class StandstillDetector {
 public:
  /// Takes the newest pose; repetitions are ignored.
  void take(const PoseReading& pose);
  /// Whether the vehicle has been at rest for a moment, by poses measured after `since` [us] only.
  bool stands(int64_t since) const;

 private:
  static constexpr int64_t kMoment = 200'000;  ///< [us]
  static constexpr double kSlow = 0.08;        ///< [m/s, rad/s]

  std::deque<PoseReading> poses_;
};

/// Detects that the vehicle no longer approaches its goal.
class ProgressMonitor {
 public:
  /// `patience` [us] without progress is too long.
  explicit ProgressMonitor(int64_t patience) : patience_(patience) {}

  void restart(int64_t now);
  /// Takes the distance to the goal [m]. Returns true after too long without progress, and
  /// restarts.
  /** A path that has become much longer means a detected dead end: the patience restarts, but only
   * a few times. */
  bool stuck(double distance_to_go, int64_t now);

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

/// Moves for a vehicle that stands without a path: back a little, or turn and look.
class Recovery {
 public:
  /// Ids of patterns from rest to rest over free ground; empty if there are none.
  /** Each call prefers another kind: backing out, turning one way, turning the other way. On
   * blocked ground only moves that overlap no more than the vehicle already does. */
  std::vector<int> propose(const PatternTable& table, const CollisionChecker& collision_checker,
                           const Pose2& T_map_body);
  int tries() const { return tries_; }
  void restart() { tries_ = 0; }

 private:
  int tries_ = 0;
};

/// Control at standstill: sets off or, if no pattern is free, waits, tries recoveries, and gives a
/// path up.
class StandingControl {
 public:
  StandingControl(DrivingState& state, MovingControl& moving) : state_(state), moving_(moving) {}

  void stand(const PlannerInputs& s, const Preconditions& ready, ProgressMonitor& progress);
  bool arrived() const { return arrived_; }
  /// Another goal.
  void restart() {
    arrived_ = false;
    blocked_since_.reset();
    recovery_.restart();
  }
  void forgetBlocked() { blocked_since_.reset(); }
  /// The vehicle has continued with another pattern: several in a row end a recovery.
  void noteJoined();

 private:
  void planStart(const PlannerInputs& s);
  void begin(const PlannerInputs& s, const std::vector<PlanStep>& steps);
  void noPlan(const PlannerInputs& s, const Reason& why);
  void tryRecovery(const PlannerInputs& s);

  DrivingState& state_;
  MovingControl& moving_;
  Recovery recovery_;
  bool arrived_ = false;
  int joined_ = 0;                        ///< patterns since the last recovery
  std::optional<int64_t> blocked_since_;  ///< [us] standing, without a free pattern
};

}  // namespace tread::planner
