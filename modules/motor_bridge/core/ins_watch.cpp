// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/core/ins_watch.hpp"

namespace tread::motor {

void InsWatch::receive(const InsNotice& notice, int64_t now) {
  const bool future = notice.utime > now + limits_.max_future_us;
  const bool old = notice.utime < now - limits_.maxAge() - limits_.max_latency_us;
  const bool newer = !received_at_ || notice.utime > utime_;
  if (future || old || !newer) {
    return;
  }
  received_at_ = now;
  utime_ = notice.utime;
  usable_ = notice.usable;
}

std::string InsWatch::fault(int64_t now) const {
  if (!received_at_) {
    return "no INS yet";
  }
  if (now - *received_at_ > limits_.maxAge()) {
    return "INS is stale: nothing new within " + std::to_string(limits_.maxAge() / 1000) + " ms";
  }
  if (now - utime_ > limits_.maxAge() + limits_.max_latency_us) {
    return "INS is stale: its newest measurement is too old";
  }
  return usable_ ? "" : "INS knows no position or no heading";
}

}  // namespace tread::motor
