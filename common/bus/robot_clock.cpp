// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/bus/robot_clock.hpp"

#include <algorithm>

namespace tread {

void RobotClock::observe(int64_t utime, int64_t host) {
  if (now_ && host - span_began_ > kSpan) {
    before_ = now_;
    now_.reset();
  }
  if (!now_) span_began_ = host;
  now_ = std::max(now_.value_or(INT64_MIN), utime - host);
}

std::optional<int64_t> RobotClock::offset() const {
  return now_ && before_ ? std::max(*now_, *before_) : now_;
}

}  // namespace tread
