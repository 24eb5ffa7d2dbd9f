// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/core/safeguards.hpp"

namespace tread::motor {

void InsWatch::receive(const InsNotice& notice, int64_t now) {
  const bool future = notice.utime > now + limits_.max_future_us;
  const bool old = notice.utime < now - limits_.maxAge() - limits_.max_latency_us;
  const bool newer = !received_at_ || notice.utime > utime_;
  if (future || old || !newer) return;
  received_at_ = now;
  utime_ = notice.utime;
  usable_ = notice.usable;
}

std::string InsWatch::fault(int64_t now) const {
  if (!received_at_) return "no INS yet";
  if (now - *received_at_ > limits_.maxAge())
    return "INS is stale: nothing new within " + std::to_string(limits_.maxAge() / 1000) + " ms";
  if (now - utime_ > limits_.maxAge() + limits_.max_latency_us)
    return "INS is stale: its newest measurement is too old";
  return usable_ ? "" : "INS knows no position or no heading";
}

bool OperatorRequests::timely(int64_t utime, int64_t now) const {
  constexpr int64_t kMaxAge = 1'500'000;  // [us]; requests are repeated for a second
  constexpr int64_t kMaxFuture = 50'000;  // [us]
  return utime <= now + kMaxFuture && utime >= now - kMaxAge;
}

OperatorRequests::Effect OperatorRequests::classify(const ArmRequest& request, int64_t now,
                                                    int64_t disarmed_at) {
  if (!request.armed) return Effect::kDisarm;
  const bool served = request.utime <= served_utime_;
  const bool after_stop = request.utime > disarmed_at;
  return timely(request.utime, now) && after_stop && !served ? Effect::kArm : Effect::kIgnored;
}

bool OperatorRequests::receive(const EstopRequest& request, int64_t now) {
  if (request.engaged) {
    engaged_ = true;
    engaged_utime_ = std::max(engaged_utime_, std::min(request.utime, now));
    reason_ = request.why + " (" + request.by + ")";
    return true;
  }
  if (!engaged_ || !timely(request.utime, now) || request.utime < engaged_utime_) return false;
  engaged_ = false;
  reason_.clear();
  return true;
}

}  // namespace tread::motor
