// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/core/track_monitor.hpp"

#include <algorithm>
#include <vector>

#include "common/statistics/statistics.hpp"

namespace tread::ins {
namespace {

constexpr size_t kIntervals = 9;
constexpr size_t kFewestIntervals = 3;

}  // namespace

int64_t TrackMonitor::typicalPeriod() const {
  if (period_us_ > 0) return period_us_;
  if (intervals_.size() < kFewestIntervals) return 0;
  return upperMedian(std::vector<int64_t>(intervals_.begin(), intervals_.end()));
}

bool TrackMonitor::isGap(int64_t utime) {
  if (!last_utime_) {
    last_utime_ = utime;
    return false;
  }
  const int64_t interval = utime - *last_utime_;
  last_utime_ = utime;
  const int64_t period = typicalPeriod();
  intervals_.push_back(interval);
  if (intervals_.size() > kIntervals) intervals_.pop_front();
  return period > 0 && interval > 3 * period;
}

bool TrackMonitor::canCome(const Place& from, const Place& to) const {
  const double dt = static_cast<double>(to.utime - from.utime) * 1e-6;
  return (to.p_map - from.p_map).norm() <= max_speed_ * dt + slack_;
}

TrackStep TrackMonitor::judge(int64_t utime, const Eigen::Vector3d& p_map_body) {
  const Place place{utime, p_map_body.head<2>()};
  const bool goes_on = !last_ || canCome(*last_, place);
  if (!goes_on && !(doubted_ && canCome(*doubted_, place))) {
    doubted_ = place;
    return TrackStep::kDoubted;
  }
  last_ = place;
  doubted_.reset();
  return goes_on ? TrackStep::kNear : TrackStep::kJump;
}

}  // namespace tread::ins
