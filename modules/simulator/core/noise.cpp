// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/simulator/core/noise.hpp"

namespace tread::sim {
namespace {

/// How long the ground stays like itself under a moving vehicle [s].
constexpr double kCorrelationTime = 2.0;
/// The calibration's executions last this long [s].
constexpr double kExecutionTime = 1.0;

}  // namespace

MotionNoise::MotionNoise(uint64_t seed, double step)
    : gaussian_(seed),
      forward_(kCorrelationTime, step, gaussian_),
      yaw_(kCorrelationTime, step, gaussian_),
      heading_(kCorrelationTime, step, gaussian_),
      scale_(1.0 / std::sqrt(OrnsteinUhlenbeck::varianceOfMean(kCorrelationTime, kExecutionTime))) {
}

void MotionNoise::step() {
  forward_.step(gaussian_);
  yaw_.step(gaussian_);
  heading_.step(gaussian_);
}

MotionFactors MotionNoise::factors(const MotionSpread& spread) const {
  return {1.0 + scale_ * spread.forward * forward_.value(),
          1.0 + scale_ * spread.yaw * yaw_.value(), scale_ * spread.heading * heading_.value()};
}

Twist2 MotionNoise::disturb(const Twist2& v_body, const MotionSpread& spread) const {
  const MotionFactors now = factors(spread);
  const double v_x = v_body.v_x * now.forward;
  return {v_x, v_body.v_y + v_x * std::tan(now.heading), v_body.omega * now.yaw};
}

}  // namespace tread::sim
