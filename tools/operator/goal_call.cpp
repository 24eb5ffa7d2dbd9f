// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/operator/goal_call.hpp"

#include <cstdio>
#include <utility>

namespace tread::operators {
namespace {

constexpr int64_t kRepeat = 1'000'000;  // [us]

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
  goal_t goal{};
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
  if (begun_ < 0) begun_ = utime;
  if (utime >= next_) {
    send(utime, goal_id_);
    next_ = utime + kRepeat;
  }
  if (!progress_.plan().any() || !isOurs(progress_.plan().message())) return CallResult::kGoesOn;
  const int16_t status = progress_.plan().message().plan_status;
  if (status == plan_t::PLAN_ARRIVED) return CallResult::kDone;
  if (!isStuck(status)) stuck_since_ = -1;
  if (isStuck(status) && stuck_since_ < 0) stuck_since_ = utime;
  const auto patience = static_cast<int64_t>(request_.patience * 1e6);
  return stuck_since_ >= 0 && utime - stuck_since_ > patience ? CallResult::kRefused
                                                              : CallResult::kGoesOn;
}

std::string GoalCall::words(int64_t utime) const {
  char time[32];
  std::snprintf(time, sizeof time, "%5.0f s  ", static_cast<double>(utime - begun_) * 1e-6);
  return (begun_ < 0 ? std::string() : time) + progress_.line(utime);
}

void GoalCall::cancel(int64_t utime) {
  send(utime, 0);
}

}  // namespace tread::operators
