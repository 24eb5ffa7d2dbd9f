// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/ins_driver/novatel/imu_rate.hpp"

#include <algorithm>
#include <cmath>

#include "common/geometry/se2.hpp"
#include "common/statistics/statistics.hpp"

namespace tread::ins {
namespace {

constexpr double kUsualRates[] = {100.0, 125.0, 200.0, 250.0, 400.0, 500.0, 1000.0, 2000.0};
constexpr size_t kRatios = 9;
constexpr double kFit = 0.08;  ///< tolerance of a median for a common rate
constexpr double kLeastTurn =
    0.02;  ///< below this yaw change between two attitudes noise would dominate [rad]
constexpr int64_t kMaxBaseUs = 1'000'000;

}  // namespace

ImuRate::ImuRate(double configured) {
  if (configured > 0.0) rate_ = configured;
}

void ImuRate::addSample(int64_t /*time*/, double yaw_per_sample) {
  sum_per_sample_ += yaw_per_sample;
  ++samples_;
}

void ImuRate::addYaw(int64_t time, double yaw) {
  if (rate_) return;
  const int64_t base = time - yaw_time_;
  const bool usable = yaw_ && base > 0 && base <= kMaxBaseUs && samples_ > 0;
  const double turned = usable ? wrapAngle(yaw - *yaw_) : 0.0;
  if (usable && std::abs(turned) < kLeastTurn) return;  // wait for more
  if (usable) {
    const double per_second = turned / (static_cast<double>(base) * 1e-6);
    ratios_.push_back(per_second / (sum_per_sample_ / samples_));
  }
  yaw_ = yaw;
  yaw_time_ = time;
  sum_per_sample_ = 0.0;
  samples_ = 0;
  if (ratios_.size() < kRatios) return;
  const double median = valueAtRank(std::exchange(ratios_, {}), kRatios / 2);
  for (const double usual : kUsualRates) {
    if (std::abs(median / usual - 1.0) < kFit) rate_ = usual;
  }
}

}  // namespace tread::ins
