// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/core/attitude_memory.hpp"

#include <cmath>

#include "common/geometry/se2.hpp"

namespace tread::ins {
namespace {

/// Headings farther apart give no rate: a tracked vehicle can have turned either way.
constexpr int64_t kMaxRateBaseUs = 250'000;

}  // namespace

void AttitudeMemory::add(int64_t utime, const Attitude& attitude) {
  const int64_t base = utime - newest_utime_;
  rate_.reset();
  if (newest_ && base > 0 && base <= kMaxRateBaseUs)
    rate_ = wrapAngle(attitude.yaw - newest_->yaw) / (static_cast<double>(base) * 1e-6);
  newest_ = attitude;
  newest_utime_ = utime;
}

std::optional<Attitude> AttitudeMemory::at(int64_t utime) const {
  const int64_t age = utime - newest_utime_;
  if (!newest_ || age < 0 || age > hold_us_) return std::nullopt;
  if (age == 0) return newest_;
  Attitude attitude = *newest_;
  if (!rate_) return attitude;
  const double turned = *rate_ * static_cast<double>(age) * 1e-6;
  attitude.yaw = wrapAngle(attitude.yaw + turned);
  attitude.yaw_std = std::hypot(attitude.yaw_std, turned);
  return attitude;
}

void AttitudeMemory::complete(int64_t utime, Attitude& attitude) const {
  const int64_t age = utime - newest_utime_;
  if (attitude.pitch || attitude.roll || !newest_ || age < 0 || age > hold_us_) return;
  attitude.pitch = newest_->pitch;
  attitude.roll = newest_->roll;
  attitude.pitch_std = newest_->pitch_std;
  attitude.roll_std = newest_->roll_std;
}

std::optional<double> AttitudeMemory::yawRate(int64_t utime) const {
  const int64_t age = utime - newest_utime_;
  return age >= 0 && age <= hold_us_ ? rate_ : std::nullopt;
}

void AttitudeMemory::clear() {
  newest_.reset();
  rate_.reset();
}

}  // namespace tread::ins
