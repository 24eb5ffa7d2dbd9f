// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/operator/goal_call.hpp"

#include <cstdio>
#include <utility>

#include "common/messages/blank.hpp"

namespace tread::operators {
namespace {

constexpr int64_t kRepeat = 1'000'000;  // [us]

/// A robot that lost its permission on the way does not go on by itself [us].
constexpr int64_t kDisarmedPatience = 2'000'000;

bool isStuck(int16_t status) {
  return status == plan_t::PLAN_BLOCKED || status == plan_t::PLAN_UNREACHABLE;
}

}  // namespace

GoalCall::GoalCall(Bus& bus, const GoalRequest& request, int64_t goal_id,
                   SurfaceNames surface_names)
    : bus_(bus),
      request_(request),
      goal_id_(goal_id),
      progress_(bus, request.T_map_goal, std::move(surface_names)) {}

void GoalCall::send(int64_t utime, int64_t goal_id) {
  auto goal = blank<goal_t>();
  goal.utime = utime;
  goal.seq = seq_++;
  goal.goal_id = goal_id;
  goal.goal_pose[0] = request_.T_map_goal.x;
  goal.goal_pose[1] = request_.T_map_goal.y;
  goal.goal_pose[2] = request_.T_map_goal.yaw;
  goal.position_tolerance = request_.position_tolerance;
  goal.yaw_tolerance = request_.yaw_tolerance;
  bus_.publish(kGoal, goal);
}

CallResult GoalCall::step(int64_t utime) {
  if (!started_) started_ = utime;
  if (utime >= next_) {
    send(utime, goal_id_);
    next_ = utime + kRepeat;
  }
  if (lostPermission(utime)) return CallResult::kRefused;
  if (!progress_.plan().any() || !isOurs(progress_.plan().message())) return CallResult::kPending;
  const int16_t status = progress_.plan().message().plan_status;
  if (status == plan_t::PLAN_ARRIVED) return CallResult::kDone;
  if (!isStuck(status)) stuck_since_.reset();
  if (isStuck(status) && !stuck_since_) stuck_since_ = utime;
  const auto patience = static_cast<int64_t>(request_.patience * 1e6);
  return stuck_since_ && utime - *stuck_since_ > patience ? CallResult::kRefused
                                                          : CallResult::kPending;
}

/// Was armed, and is not any more for a while. Before the first arming the goal just waits.
bool GoalCall::lostPermission(int64_t utime) {
  if (!progress_.motor().any()) return false;
  const bool may = mayDrive(progress_.motor().message().bridge_state);
  was_armed_ = was_armed_ || may;
  if (may) disarmed_since_.reset();
  if (!may && was_armed_ && !disarmed_since_) disarmed_since_ = utime;
  return disarmed_since_ && utime - *disarmed_since_ > kDisarmedPatience;
}

std::string GoalCall::describe(int64_t utime) const {
  char time[32] = "";
  if (started_)
    std::snprintf(time, sizeof time, "%5.0f s  ", static_cast<double>(utime - *started_) * 1e-6);
  std::string words = time + progress_.line(utime);
  if (disarmed_since_)
    words += "; not armed any more (" + progress_.motor().message().state_reason +
             "): tread-arm, then again";
  return words;
}

void GoalCall::cancel(int64_t utime) {
  send(utime, 0);
}

}  // namespace tread::operators
