// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/missions/operator.hpp"

#include "common/messages/blank.hpp"

namespace tread::missions {
namespace {

constexpr int64_t kGoalPeriod = 1'000'000;
constexpr int64_t kFirstArming = 3'000'000;  ///< [us] after the start: all processes are up by then
constexpr int64_t kArmAgainAfter = 2'000'000;  ///< [us] of standing disarmed: time to look around
constexpr int64_t kArmRepeats = 1'000'000;     ///< [us] for which ARM is repeated

}  // namespace

Operator::Operator(Bus& bus, const Pose2& T_map_goal)
    : bus_(bus), T_map_goal_(T_map_goal), motor_(bus, kMotor), start_(bus.now()) {}

void Operator::step(int64_t utime) {
  if (utime >= next_goal_) {
    sendGoal(utime);
    next_goal_ = utime + kGoalPeriod;
  }
  if (needsArming(utime)) {
    ++arming_;
    arm_until_ = utime + kArmRepeats;
  }
  if (utime < arm_until_) sendArm(utime);
}

bool Operator::needsArming(int64_t utime) {
  if (utime < start_ + kFirstArming || utime < arm_until_ || !motor_.any()) return false;
  const int16_t state = motor_.message().bridge_state;
  const bool may_drive = state == motor_t::STATE_ARMED || state == motor_t::STATE_DRIVING;
  if (may_drive) {
    disarmed_since_ = -1;
    return false;
  }
  if (disarmed_since_ < 0) disarmed_since_ = utime;
  if (arming_ > 0 && utime < disarmed_since_ + kArmAgainAfter) return false;
  disarmed_since_ = -1;
  return true;
}

void Operator::sendGoal(int64_t utime) {
  auto goal = blank<goal_t>();
  goal.utime = utime;
  goal.seq = seq_goal_++;
  goal.goal_id = 1;
  goal.goal_pose[0] = T_map_goal_.x;
  goal.goal_pose[1] = T_map_goal_.y;
  goal.goal_pose[2] = T_map_goal_.yaw;
  goal.position_tolerance = 0.6;
  goal.yaw_tolerance = kPi;
  bus_.publish(kGoal, goal);
}

void Operator::sendArm(int64_t utime) {
  auto arm = blank<arm_t>();
  arm.utime = utime;
  arm.seq = seq_arm_++;
  arm.armed = true;
  arm.armed_by = "mission operator";
  arm.arm_reason = arming_ == 1 ? "mission begins" : "armed again after a stop";
  bus_.publish(kArm, arm);
}

}  // namespace tread::missions
