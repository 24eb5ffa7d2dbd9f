// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/emulators/vesc/vesc_motor.hpp"

#include <algorithm>

namespace tread::sim {
namespace {

// Of the speed control, for errors in full speed (5000 electrical rpm) and seconds.
constexpr double kSpan = 5000.0;
constexpr double kProportional = 1.0;
constexpr double kIntegral = 4.0;

}  // namespace

void VescMotor::set(Mode mode, double wanted, int64_t utime) {
  output(utime);
  if (mode != mode_) sum_ = 0.0;
  mode_ = mode;
  wanted_ = wanted;
  fed_ = utime;
}

void VescMotor::setDuty(double duty, int64_t utime) {
  set(Mode::kDuty, std::clamp(duty, -1.0, 1.0), utime);
}

void VescMotor::setRpm(double erpm, int64_t utime) {
  set(Mode::kRpm, erpm, utime);
}

void VescMotor::setBrake(double /*amperes*/, int64_t utime) {
  set(Mode::kDuty, 0.0, utime);
}

void VescMotor::measure(double track_speed, double current, double battery) {
  erpm_ = settings_.erpm_per_mps * track_speed;
  current_ = current;
  battery_ = battery;
}

void VescMotor::powerUp() {
  mode_ = Mode::kReleased;
  wanted_ = sum_ = power_ = 0.0;
}

double VescMotor::output(int64_t utime) {
  const double dt = 1e-6 * static_cast<double>(std::clamp<int64_t>(utime - stepped_, 0, 10'000));
  stepped_ = std::max(stepped_, utime);
  if (settings_.timeout_ms > 0 && utime - fed_ >= 1000 * settings_.timeout_ms) powerUp();
  if (fault_ != 0) return power_ = 0.0;
  if (mode_ != Mode::kRpm) return power_ = mode_ == Mode::kDuty ? wanted_ : 0.0;
  const double error = (wanted_ - erpm_) / kSpan;
  sum_ = wanted_ == 0.0 ? 0.0 : std::clamp(sum_ + kIntegral * error * dt, -1.0, 1.0);
  return power_ = std::clamp(kProportional * error + sum_, -1.0, 1.0);
}

}  // namespace tread::sim
