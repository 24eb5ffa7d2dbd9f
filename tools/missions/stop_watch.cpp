// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/missions/stop_watch.hpp"

#include <cmath>

namespace tread::missions {

void StopWatch::step(int64_t utime, const Twist2& v_body, const SaidReason& said) {
  const bool slow = std::hypot(v_body.v_x, v_body.v_y) < kSlow && std::abs(v_body.omega) < kSlow;
  if (!slow && begun_ == 0) begun_ = utime;
  if (!slow && last_step_ != 0) driven_ += utime - last_step_;
  last_step_ = utime;
  if (slow && !slow_) slowed_ = {utime, utime, said.planner.empty() ? said.bridge : said.planner};
  slow_ = slow;
  if (!slow) resting_ = false;
  if (!slow || begun_ == 0) return;
  if (resting_) {
    rests_.back().to = utime;
  } else if (utime - slowed_.from >= kMoment) {
    rests_.push_back({slowed_.from, utime, slowed_.reason});
    resting_ = true;
  }
}

std::vector<Stop> StopWatch::stops(int64_t start, bool arrived) const {
  std::vector<Stop> stops;
  for (const Rest& rest : rests_)
    stops.push_back({static_cast<double>(rest.from - start) * 1e-6,
                     static_cast<double>(rest.to - rest.from) * 1e-6, rest.reason});
  if (arrived && resting_) stops.pop_back();
  return stops;
}

}  // namespace tread::missions
