// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

namespace tread::ins {

/// Learns how many samples a second an IMU has whose turning is told per sample.
/** The time stamps do not tell: the receiver may log every n-th sample. What tells is the attitude:
   yaw turned in a second over yaw turned in a sample. Nine agreeing ratios while the vehicle turns,
   near a rate that such IMUs have, are believed. */
class ImuRate {
 public:
  /// `configured`: 0 = learn it [Hz].
  explicit ImuRate(double configured);

  /// A yaw of the inertial solution at a GPS time [us].
  void addYaw(int64_t time, double yaw);
  /// Yaw turned in the sample at a GPS time [us], counter-clockwise [rad].
  void addSample(int64_t time, double yaw_per_sample);
  /// [Hz]; nothing before it is known.
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
