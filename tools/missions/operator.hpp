// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/bus/bus.hpp"
#include "common/geometry/se2.hpp"

namespace tread::missions {

/// The person at the remote control: sends the goal, arms, and arms again after a failsafe.
class Operator {
 public:
  Operator(Bus& bus, const Pose2& T_map_goal);

  void step(int64_t utime);
  /// How often it had to arm again.
  int rearmed() const { return arming_ - 1 < 0 ? 0 : arming_ - 1; }

 private:
  void sendGoal(int64_t utime);
  void sendArm(int64_t utime);
  bool needsArming(int64_t utime);

  Bus& bus_;
  Pose2 T_map_goal_;
  Latest<motor_t> motor_;
  int64_t start_;
  int64_t next_goal_ = 0;
  int64_t arm_until_ = 0;  ///< ARM is repeated until then
  int64_t disarmed_since_ = -1;
  int arming_ = 0;
  int64_t seq_goal_ = 0;
  int64_t seq_arm_ = 0;
};

}  // namespace tread::missions
