// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cmath>

namespace tread::sim {

/// The speed loop of a motor controller for one track: proportional and integral, added to the
/// power for the speed without load.
class SpeedLoop {
 public:
  /// `full_speed` [m/s] of the track at full power without load.
  explicit SpeedLoop(double full_speed) : full_speed_(full_speed) {}

  /// Power, -1..1, for a wanted and a measured track speed [m/s]; call it every dt [s].
  double step(double wanted, double measured, double dt) {
    const double error = (wanted - measured) / full_speed_;
    const double power = wanted / full_speed_ + kProportional * error + integral_;
    // Avoids wind-up in saturation.
    if (std::abs(power) < 1.0 || power * error < 0.0) integral_ += kIntegral * error * dt;
    return std::clamp(power, -1.0, 1.0);
  }

 private:
  static constexpr double kProportional = 2.0;  // power per error of the full speed
  static constexpr double kIntegral = 2.0;      // the same per second
  double full_speed_;
  double integral_ = 0.0;
};

}  // namespace tread::sim
