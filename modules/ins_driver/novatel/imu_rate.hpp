// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace tread::ins {

/// Estimates the sample rate of an IMU whose rotation is reported per sample.
/** The time stamps do not give it, because the receiver may log every n-th sample. The attitude
 * does: yaw change per second over yaw change per sample. Nine agreeing ratios during turns, near
 * a common rate of such IMUs, are accepted. */
class ImuRate {
 public:
  /// `configured`: 0 = learn it [Hz].
  explicit ImuRate(double configured);

  /// Adds a yaw of the inertial solution at a GPS time [us].
  void addYaw(int64_t time, double yaw);
  /// Adds the yaw change in the sample at a GPS time [us], counter-clockwise [rad].
  void addSample(int64_t time, double yaw_per_sample);
  /// [Hz]; nullopt until known.
  const std::optional<double>& rate() const { return rate_; }

 private:
  std::optional<double> rate_;
  std::optional<double> yaw_;
  int64_t yaw_time_ = 0;
  double sum_per_sample_ = 0.0;
  int samples_ = 0;
  std::vector<double> ratios_;
};

}  // namespace tread::ins
