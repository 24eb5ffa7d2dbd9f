// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <tread/plan_t.hpp>

#include "common/geometry/se2.hpp"
#include "common/pattern/pattern.hpp"

namespace tread::missions {

/// The planner changed from one side to the other.
struct Flip {
  double time = 0.0;  ///< [s] since the start of the mission
  std::string from;   ///< pattern that turned to the old side
  std::string to;     ///< and the one that turns to the new one
};

/// Finds flips in published plans: the robot dithers between left and right.
/** A flip is a plan that turns to the other side than the plan published before, although that one
 * could still have been driven.
 *  1. What is compared begins where the decision is still open: after the pattern that runs. Of the
 * plan before, patterns that have begun meanwhile are passed over; if another one was begun than it
 * said, the comparison begins with that one.
 *  2. A plan turns to the side of its first pattern that begins within the next 3 s and changes the
 * heading by more than 0.12 rad (7 degrees). A plan without one has no side, and that which the
 * plan before had stays in mind: left, straight on and right is a flip, too.
 *  3. The plan before could have been driven if its patterns, laid on the newest prediction with
 * the newest set, all touch no obstacle of the newest map with the planner's checking margin.
 *  So a bend to the left followed by one to the right is no flip as long as it was planned so, nor
 * is turning away from what has newly come into sight; a way that is merely better is one. */
class FlipDetector {
 public:
  /// Whether patterns, one after the other from a pose, touch nothing that is known now.
  using IsFree =
      std::function<bool(const Pose2& T_map_start, const std::vector<const MotionPattern*>&)>;

  explicit FlipDetector(IsFree is_free) : is_free_(std::move(is_free)) {}

  /// Sets the newest pattern set; without one no flip is detected.
  void take(const PatternSet& set) { set_ = set; }
  /// Takes the next plan; returns a flip (without its time) if it is one.
  std::optional<Flip> hear(const plan_t& plan);

 private:
  static constexpr double kTurn = 0.12;  ///< [rad]
  static constexpr double kAhead = 3.0;  ///< [s]
  using Patterns = std::vector<const MotionPattern*>;

  std::optional<Patterns> patternsOf(const std::vector<int32_t>& ids) const;
  /// The first pattern that turns; nullptr = the plan has no side.
  const MotionPattern* turnOf(const Patterns& patterns) const;

  IsFree is_free_;
  std::optional<PatternSet> set_;
  int64_t running_ = 0;            ///< execution id
  std::vector<int32_t> intended_;  ///< after the running one, of the last plan that had a side
};

/// The robot came to rest between start and goal.
struct Stop {
  double time = 0.0;      ///< [s] since the start of the mission
  double duration = 0.0;  ///< [s] that it stood
  std::string reason;     ///< as published; empty = none
};

/// The reasons published when the robot slowed down.
struct StopReasons {
  std::string planner;  ///< PLAN: its reason
  std::string bridge;   ///< EXECUTION: why the last one was aborted, if it was
};

/// Detects each time the true robot comes to rest after it has moved.
/** At rest: slower than 5 cm/s and 0.05 rad/s for 0.2 s, so that joins through rest (a turn on the
 * spot, backing up) count, too. The reason is the planner's when the robot became so slow, or the
 * bridge's if the planner published none. Standing before the first motion is no stop. */
class StopDetector {
 public:
  /// Call every 50 ms of virtual time [us] with the true velocity.
  void step(int64_t utime, const Twist2& v_body, const StopReasons& reasons);

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
