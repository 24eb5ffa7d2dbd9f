// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/messages/ins_queue.hpp"

#include <algorithm>
#include <limits>

#include "common/messages/ins_messages.hpp"

namespace tread {
namespace {

/// Ten seconds at 100 Hz; more than that cannot be waiting for its turn.
constexpr size_t kMaxWaiting = 1000;
/// No clock of the robot is this far ahead of another [us].
constexpr int64_t kMaxAheadUs = 1'000'000;

}  // namespace

void InsQueue::add(const ins_t& ins, int64_t now) {
  if (ins.utime <= 0 || ins.utime > now + kMaxAheadUs) {
    ++invalid_;
    return;
  }
  if (begin_ == INT64_MIN) begin_ = ins.utime;
  if (ins.utime <= settled_ || waiting_.size() >= kMaxWaiting) {
    ++too_late_;
    return;
  }
  waiting_[{ins.utime, ins.seq}] = ins;
}

void InsQueue::settle(int64_t horizon) {
  while (!waiting_.empty() && waiting_.begin()->first.first <= horizon) {
    append(waiting_.begin()->second);
    waiting_.erase(waiting_.begin());
  }
  settled_ = std::max(settled_, horizon);
}

void InsQueue::append(const ins_t& ins) {
  // A jump counts even if its own message has no pose: what follows is a new track.
  jumped_ = jumped_ || (ins.ins_status & ins_t::STATUS_JUMP) != 0;
  const auto T_map_body = planarPose(ins);
  if (!T_map_body) {
    ++without_pose_;
    return;
  }
  const double slope = inclination(ins).value_or(std::numeric_limits<double>::quiet_NaN());
  if (history_.push(ins.utime, *T_map_body, slope, jumped_)) jumped_ = false;
}

}  // namespace tread
