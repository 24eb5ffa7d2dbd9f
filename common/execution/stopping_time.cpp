// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/execution/stopping_time.hpp"

#include <algorithm>
#include <cmath>

namespace tread {
namespace {

constexpr double kFast = 0.3;          // [m/s] least initial speed of an informative stop
constexpr double kStands = 0.03;       // [m/s]
constexpr size_t kSamples = 5;         // stops that count
constexpr double kCaution = 1.3;       // [1] times the longest of them: speed and ground vary
constexpr double kLeast = 0.5;         // [1] of what is configured
constexpr double kMost = 3.0;          // [s]
constexpr int64_t kMostGap = 200'000;  // [us] between measurements

}  // namespace

void StoppingTime::command(bool zero, int64_t now) {
  if (zero == zero_) return;
  zero_ = zero;
  zero_since_.reset();
  if (zero)
    zero_since_ = now;
  else if (stop_)
    end();  // cut short, it may still be longer than the known ones
}

void StoppingTime::measure(int64_t utime, const Pose2& T_map_body, double speed) {
  if (utime <= newest_ || !std::isfinite(speed)) return;
  // Before the first measurement there is no previous one.
  if (newest_ == INT64_MIN) newest_ = utime - kMostGap - 1;
  const double before = speed_;
  const Pose2 pose_before = pose_;
  const bool gap = utime - newest_ > kMostGap;
  pose_ = T_map_body;
  newest_ = utime;
  speed_ = std::abs(speed);
  if (gap) {
    stop_.reset();
    zero_since_.reset();
  } else if (stop_) {
    stop_->way += distanceBetween(stop_->last, T_map_body);
    stop_->last = T_map_body;
    if (speed_ < kStands) end();
  } else if (zero_since_ && utime >= *zero_since_) {
    const double begin = std::max(before, speed_);
    // The command came between these two measurements: the whole distance counts.
    if (begin >= kFast) stop_ = Stop{begin, distanceBetween(pose_before, T_map_body), T_map_body};
    zero_since_.reset();
  }
}

void StoppingTime::end() {
  const double time = std::min(kMost, stop_->way / stop_->speed);
  // A stop cut short does not prove a shorter one.
  const bool whole = speed_ < kStands;
  stop_.reset();
  if (!whole && kCaution * time <= seconds()) return;
  samples_.push_back(time);
  if (samples_.size() > kSamples) samples_.pop_front();
  ++count_;
}

double StoppingTime::seconds() const {
  if (samples_.empty()) return configured_;
  const double longest = kCaution * *std::max_element(samples_.begin(), samples_.end());
  const double least = samples_.size() < kSamples ? configured_ : kLeast * configured_;
  return std::max(longest, least);
}

}  // namespace tread
