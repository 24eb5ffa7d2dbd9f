// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/bench/faults/limit_rules.hpp"

#include <algorithm>
#include <cmath>

#include "common/messages/fence_messages.hpp"
#include "common/messages/ins_messages.hpp"

namespace tread::faults {
namespace {

constexpr double kTimeToStop = 0.9;         // [s] at its speed, from the message to standstill
constexpr double kWellWithin = 0.3;         // [m] margin for swinging while it enters and turns
constexpr double kMisplaced = 0.05;         // [m] beyond the INS's own uncertainty
constexpr double kMisturned = 0.1;          // [rad]
constexpr int64_t kKept = 2'000'000;        // [us] history of true poses
constexpr int64_t kAfterBlind = 1'500'000;  // [us] until it stands again
constexpr int64_t kToSay = 250'000;         // [us] from a cause to the planner's reaction
const std::string kPerson = "mission operator";

bool isPersons(const std::string& by) {
  const std::string suffix = " (" + kPerson + ")";
  return by == kPerson || (by.size() > suffix.size() &&
                           by.compare(by.size() - suffix.size(), suffix.size(), suffix) == 0);
}

}  // namespace

FenceRule::FenceRule(const std::vector<Fence>& own, const FootprintSize& outline)
    : outline_(outline) {
  for (const Fence& fence : own) add(fence, true);
}

void FenceRule::add(const Fence& fence, bool own) {
  watched_.push_back({fence, own});
}

void FenceRule::start() {
  watched_.erase(std::remove_if(watched_.begin(), watched_.end(),
                                [](const Watched& watched) { return !watched.own; }),
                 watched_.end());
}

void FenceRule::receive(const Received& received) {
  compare(received);
  const auto message = messageOf(kFence, received);
  if (!message || !isPersons(message->fence_by)) return;
  const FenceRequest request = requestFrom(*message);
  const auto same = [&](const Watched& watched) {
    return request.removes ? !watched.own && watched.fence.name == request.fence.name
                           : watched.fence == request.fence;
  };
  const auto found = std::find_if(watched_.begin(), watched_.end(), same);
  if (request.removes) {
    watched_.erase(std::remove_if(watched_.begin(), watched_.end(), same), watched_.end());
  } else if (found == watched_.end() && faultOf(request.fence).empty()) {
    add(request.fence, false);
  }
}

/// Is the pose of the INS correct?
void FenceRule::compare(const Received& received) {
  const auto ins = messageOf(kIns, received);
  const auto told = ins ? planarPose(*ins) : std::nullopt;
  if (!told) return;
  const auto then = std::find_if(places_.rbegin(), places_.rend(),
                                 [&](const Place& place) { return place.utime <= ins->utime; });
  if (then == places_.rend()) return;
  misled_ =
      distanceBetween(*told, then->T_map_body) > kMisplaced + positionMargin(horizontalStd(*ins)) ||
      std::abs(wrapAngle(told->yaw - then->T_map_body.yaw)) > kMisturned;
}

void FenceRule::excuse() {
  for (Watched& watched : watched_) {
    watched.within = false;
    watched.needed = kWellWithin;
  }
}

std::string FenceRule::check(int64_t now, const Pose2& T_map_body, double speed) {
  places_.push_back({now, T_map_body});
  while (places_.front().utime < now - kKept) places_.pop_front();
  if (misled_ || now < blind_ + kAfterBlind) excuse();
  for (Watched& watched : watched_) {
    const double room = roomAt(watched.fence, T_map_body, outline_);
    if (room < 0.0 && !watched.within) watched.needed = kWellWithin;
    if (room >= watched.needed + kTimeToStop * std::abs(speed)) watched.within = true;
    if (!watched.within) continue;
    least_room_ = std::min(least_room_, room);
    if (room < 0.0)
      return "the outline is " + std::to_string(-room) + " m over the fence " + watched.fence.name;
  }
  return "";
}

void ReturnRule::receive(const Received& received) {
  const auto notice = messageOf(kOperator, received);
  if (!notice || notice->allowed != operator_t::ALLOW_DRIVING) return;
  if (notice->seen_utime > received.utime + 100'000) return;
  operator_seen_ = std::max(operator_seen_, notice->seen_utime);
}

std::string ReturnRule::check(int64_t now, const program_t& program) {
  const bool moves = program.running.execution_id != 0;
  if (!moves || returns_ || now <= operator_seen_ + lease_) {
    wrong_since_.reset();
    return "";
  }
  wrong_since_ = wrong_since_.value_or(now);
  if (now - *wrong_since_ <= kToSay) return "";
  return "the planner wants motion, no return, " +
         std::to_string((now - operator_seen_ - lease_) / 1000) + " ms after it lost the operator";
}

}  // namespace tread::faults
