// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <optional>
#include <string>
#include <vector>

#include <tread/plan_t.hpp>

#include "common/pattern/pattern.hpp"

namespace tread::missions {

/// The planner changed its mind from one side to the other.
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
class FlipWatch {
 public:
  /// Whether patterns, one after the other from a pose, touch nothing that is known now.
  using IsFree =
      std::function<bool(const Pose2& T_map_start, const std::vector<const MotionPattern*>&)>;

  explicit FlipWatch(IsFree is_free) : is_free_(std::move(is_free)) {}

  /// The newest pattern set; plans are not judged without one.
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

}  // namespace tread::missions
