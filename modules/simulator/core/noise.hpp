// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "common/geometry/se2.hpp"
#include "modules/simulator/core/terrain.hpp"

namespace tread::sim {

/// Seed of one of several independent random streams of one simulation (SplitMix64 finaliser).
inline uint64_t streamSeed(uint64_t seed, uint64_t stream) {
  uint64_t z = seed + (stream + 1) * 0x9E3779B97F4A7C15ULL;
  z = (z ^ (z >> 30)) * 0xBF58476D1CE4E5B9ULL;
  z = (z ^ (z >> 27)) * 0x94D049BB133111EBULL;
  return z ^ (z >> 31);
}

/// Standard normal numbers by the polar method.
/** Own code, because the standard does not define the algorithm of std::normal_distribution and the
 * same seed must give the same bytes with every library. */
class Gaussian {
 public:
  explicit Gaussian(uint64_t seed) : generator_(seed) {}

  /// One draw of N(0, 1).
  double draw() {
    if (spare_valid_) {
      spare_valid_ = false;
      return spare_;
    }
    double u = 0.0, v = 0.0, square = 0.0;
    do {
      u = uniform();
      v = uniform();
      square = u * u + v * v;
    } while (square >= 1.0 || square == 0.0);
    const double scale = std::sqrt(-2.0 * std::log(square) / square);
    spare_ = v * scale;
    spare_valid_ = true;
    return u * scale;
  }

 private:
  /// Uniform in [-1, 1), 53 bits.
  double uniform() { return static_cast<double>(generator_() >> 11) * 0x1.0p-52 - 1.0; }

  std::mt19937_64 generator_;
  double spare_ = 0.0;
  bool spare_valid_ = false;
};

/// An Ornstein-Uhlenbeck process with unit variance at rest, sampled exactly at fixed steps.
class OrnsteinUhlenbeck {
 public:
  /// Starts in its stationary distribution. Correlation time and step [s].
  OrnsteinUhlenbeck(double correlation_time, double step, Gaussian& gaussian)
      : decay_(std::exp(-step / correlation_time)),
        drive_(std::sqrt(1.0 - decay_ * decay_)),
        value_(gaussian.draw()) {}

  void step(Gaussian& gaussian) { value_ = decay_ * value_ + drive_ * gaussian.draw(); }
  double value() const { return value_; }

  /// Variance of the mean over a time [s] of a unit process with the given correlation time [s].
  static double varianceOfMean(double correlation_time, double time) {
    const double ratio = correlation_time / time;
    return 2.0 * ratio * (1.0 - ratio * (1.0 - std::exp(-1.0 / ratio)));
  }

 private:
  double decay_;
  double drive_;
  double value_;
};

/// Disturbance of a motion at one instant.
struct MotionFactors {
  double forward = 1.0;  ///< factor on the forward speed [1]
  double yaw = 1.0;      ///< factor on the yaw rate [1]
  double heading = 0.0;  ///< added to the direction of motion [rad]
};

/// Motion disturbances by the ground that no model contains: correlated in time, scaled by the
/// surface.
/** Three Ornstein-Uhlenbeck processes change forward gain, yaw gain and direction of motion. They
 * are scaled so that the mean over one second has the surface's spread; a standing vehicle stays
 * at rest. */
class MotionNoise {
 public:
  /// One step is `step` seconds long.
  MotionNoise(uint64_t seed, double step)
      : gaussian_(seed),
        forward_(kCorrelationTime, step, gaussian_),
        yaw_(kCorrelationTime, step, gaussian_),
        heading_(kCorrelationTime, step, gaussian_),
        scale_(1.0 /
               std::sqrt(OrnsteinUhlenbeck::varianceOfMean(kCorrelationTime, kExecutionTime))) {}

  /// Advances the processes by one step.
  void step() {
    forward_.step(gaussian_);
    yaw_.step(gaussian_);
    heading_.step(gaussian_);
  }

  /// Present values of the processes for a spread.
  MotionFactors factors(const MotionSpread& spread) const {
    return {1.0 + scale_ * spread.forward * forward_.value(),
            1.0 + scale_ * spread.yaw * yaw_.value(), scale_ * spread.heading * heading_.value()};
  }
  /// The body velocity that results from the dynamics' velocity on a surface.
  Twist2 disturb(const Twist2& v_body, const MotionSpread& spread) const {
    const MotionFactors now = factors(spread);
    const double v_x = v_body.v_x * now.forward;
    return {v_x, v_body.v_y + v_x * std::tan(now.heading), v_body.omega * now.yaw};
  }

 private:
  /// Correlation time of the ground under a moving vehicle [s].
  static constexpr double kCorrelationTime = 2.0;
  /// Duration of the calibration's executions [s].
  static constexpr double kExecutionTime = 1.0;

  Gaussian gaussian_;
  OrnsteinUhlenbeck forward_;
  OrnsteinUhlenbeck yaw_;
  OrnsteinUhlenbeck heading_;
  double scale_;
};

}  // namespace tread::sim
