// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <deque>
#include <limits>
#include <string>
#include <vector>

#include <tread/plan_t.hpp>
#include <tread/program_t.hpp>

#include "common/fence/fence.hpp"
#include "tests/bench/faults/invariants.hpp"

namespace tread::faults {

/// The true outline never crosses a fence of the robot's file, nor one of the operator's that the
/// bridge has received, once it was inside with enough room to stop.
/** While the INS's pose is wrong, or the bridge is gone, halted or disconnected from the motors, no
 * fence can be kept; afterwards a fence applies again once the outline is well inside. Strangers'
 * fences are not checked: they may be replaced by others. */
class FenceRule {
 public:
  FenceRule(const std::vector<Fence>& own, const FootprintSize& outline);

  /// A message delivered to the bridge.
  void receive(const Received& received);
  /// The bridge was started: it has only the robot's own fences.
  void start();
  /// The bridge cannot act.
  void blind(int64_t now) { blind_ = now; }
  /// True pose and speed [m/s] at a time; returns the violation, empty if none.
  std::string check(int64_t now, const Pose2& T_map_body, double speed);
  /// [m] least distance to a fence that applied.
  double leastRoom() const { return least_room_; }

 private:
  struct Watched {
    Fence fence;
    bool own = false;
    bool within = false;
    /// [m] required distance until it applies, in addition to the stopping distance
    double needed = 0.0;
  };
  struct Place {
    int64_t utime;  ///< [us]
    Pose2 T_map_body;
  };

  void add(const Fence& fence, bool own);
  void compare(const Received& received);
  void excuse();

  FootprintSize outline_;
  std::vector<Watched> watched_;
  std::deque<Place> places_;  ///< history, oldest first
  bool misled_ = false;       ///< the newest INS pose is wrong
  int64_t blind_ = INT64_MIN / 2;
  double least_room_ = std::numeric_limits<double>::infinity();
};

/// `lost: go_back`: without an operator the planner may command only a return.
class ReturnRule {
 public:
  explicit ReturnRule(int64_t operator_lease_us) : lease_(operator_lease_us) {}

  /// A message delivered to the planner.
  void receive(const Received& received);
  void start() { *this = ReturnRule(lease_); }
  /// A message sent by the planner.
  void sent(const plan_t& plan) { returns_ = plan.goal_id < 0; }
  /// The violation; empty if none.
  std::string check(int64_t now, const program_t& program);

 private:
  int64_t lease_;
  int64_t operator_seen_ = INT64_MIN / 2;  ///< [us]
  bool returns_ = false;
  std::optional<int64_t> wrong_since_;  ///< [us]
};

}  // namespace tread::faults
