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

/// The true outline goes over no fence of the robot's file, nor over one of the operator's that the
/// bridge was handed, once it was within it with room to stop.
/** While the INS tells the bridge another place than the true one, and while the bridge is gone,
 * halted or cut off from the motors, nobody can keep a fence: then it counts again once the outline
 * is well within. Fences of strangers are not judged: they may make room for others. */
class FenceRule {
 public:
  FenceRule(const std::vector<Fence>& own, const FootprintSize& outline);

  /// What the bridge was handed.
  void receive(const Received& received);
  /// The bridge was started: it knows the robot's own fences only.
  void start();
  /// The bridge cannot act.
  void blind(int64_t now) { blind_ = now; }
  /// The true pose and speed [m/s] at a time; what is wrong, or empty.
  std::string check(int64_t now, const Pose2& T_map_body, double speed);
  /// [m] least room to a fence that it was held to.
  double leastRoom() const { return least_room_; }

 private:
  struct Watched {
    Fence fence;
    bool own = false;
    bool within = false;
    double needed = 0.0;  ///< [m] of room until it counts, beside what it takes to stop
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
  std::deque<Place> places_;  ///< of the last moments, oldest first
  bool misled_ = false;       ///< the newest INS tells another place
  int64_t blind_ = INT64_MIN / 2;
  double least_room_ = std::numeric_limits<double>::infinity();
};

/// `lost: go_back`: while the planner has no operator it wants no motion but a return.
class ReturnRule {
 public:
  explicit ReturnRule(int64_t operator_lease_us) : lease_(operator_lease_us) {}

  /// What the planner was handed.
  void receive(const Received& received);
  void start() { *this = ReturnRule(lease_); }
  /// What the planner sends.
  void sent(const plan_t& plan) { returns_ = plan.goal_id < 0; }
  /// What is wrong, or empty.
  std::string check(int64_t now, const program_t& program);

 private:
  int64_t lease_;
  int64_t operator_seen_ = INT64_MIN / 2;  ///< [us]
  bool returns_ = false;
  std::optional<int64_t> wrong_since_;  ///< [us]
};

}  // namespace tread::faults
