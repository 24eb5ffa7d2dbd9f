// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/core/operator_requests.hpp"

#include <algorithm>

namespace tread::motor {

bool OperatorRequests::timely(int64_t utime, int64_t now) const {
  return utime <= now + limits_.max_future_us && utime >= now - limits_.max_age_us;
}

OperatorRequests::Verdict OperatorRequests::judge(const ArmRequest& request, int64_t now,
                                                  int64_t disarmed_at) {
  if (!request.armed) {
    return Verdict::kDisarm;
  }
  const bool served = request.utime <= served_utime_;
  const bool after_stop = request.utime > disarmed_at;
  return timely(request.utime, now) && after_stop && !served ? Verdict::kArm : Verdict::kIgnored;
}

bool OperatorRequests::receive(const EstopRequest& request, int64_t now) {
  if (request.engaged) {
    engaged_ = true;
    engaged_utime_ = std::max(engaged_utime_, std::min(request.utime, now));
    reason_ = request.why + " (" + request.by + ")";
    return true;
  }
  if (!engaged_ || !timely(request.utime, now) || request.utime < engaged_utime_) {
    return false;
  }
  engaged_ = false;
  reason_.clear();
  return true;
}

}  // namespace tread::motor
