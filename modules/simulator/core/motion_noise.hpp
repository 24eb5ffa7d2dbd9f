// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>

#include "common/geometry/se2.hpp"
#include "modules/simulator/core/random.hpp"
#include "modules/simulator/core/terrain.hpp"

namespace tread::sim {

/// What is made of a motion at one moment.
struct MotionFactors {
  double forward = 1.0;  ///< factor on the forward speed [1]
  double yaw = 1.0;      ///< factor on the yaw rate [1]
  double heading = 0.0;  ///< added to the direction of motion [rad]
};

/// What the ground adds to the motion and no model knows: correlated in time, scaled by the
/// surface.
/** Three Ornstein-Uhlenbeck processes change forward gain, yaw gain and direction of motion. Their
   scale is such that the mean over one second has the surface's spread; a standing vehicle stays at
   rest. */
class MotionNoise {
 public:
  /// One step is `step` seconds long.
  MotionNoise(uint64_t seed, double step);

  /// Advances the processes by one step.
  void step();

  /// What the processes are now, for a spread.
  MotionFactors factors(const MotionSpread& spread) const;
  /// The body velocity that comes out of the dynamics' velocity on a surface.
  Twist2 disturb(const Twist2& v_body, const MotionSpread& spread) const;

 private:
  Gaussian gaussian_;
  OrnsteinUhlenbeck forward_;
  OrnsteinUhlenbeck yaw_;
  OrnsteinUhlenbeck heading_;
  double scale_;
};

}  // namespace tread::sim
