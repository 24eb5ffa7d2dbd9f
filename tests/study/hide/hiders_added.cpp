// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The effects of config/effects, implemented without their formulas.
#include <algorithm>
#include <cmath>

#include "tests/study/hide/comparing.hpp"
#include "tests/study/hide/effect_list.hpp"
#include "tests/study/hide/test_field.hpp"

namespace tread::blind {
namespace {

using sim::MotorPower;

/// Soft limit of one motor's power in one direction.
Hider hideMotorLimit(double size, double, Rng& rng) {
  const double limit = 0.9 / (1.0 + 0.3 * size);
  const bool left = rng.below(2) == 0;
  const double direction = rng.sign();
  Hider hider;
  hider.drive = [=](const Moment&, MotorPower power) {
    double& own = left ? power.left : power.right;
    if (own * direction > 0.0) own /= std::pow(1.0 + std::pow(std::abs(own) / limit, 10.0), 0.1);
    return power;
  };
  const std::string name =
      std::string(left ? "left" : "right") + (direction > 0.0 ? "_forward" : "_backward");
  hider.levers = {{"power_limit_" + name, limit, "1"}};
  const double speed_per_power = plainVehicle().drive.free_speed;
  hider.equivalent = {{name + "_limit", limit * speed_per_power, "m/s"}};
  return hider;
}

/// The body turns about a point beside its centre line.
Hider hideCentreToSide(double size, double, Rng& rng) {
  const double offset = 0.03 * size * rng.sign();
  Hider hider;
  hider.slide = [=](const Moment&, Twist2 twist) {
    twist.v_x += offset * twist.omega;
    return twist;
  };
  hider.levers = {built("centre_to_the_left", offset, "m")};
  hider.equivalent = {built("offset", offset, "m")};
  return hider;
}

/// Power for turning builds up gradually and drops at once; after a reversal it starts anew.
Hider hideYawWindup(double size, double, Rng&) {
  const double time = 0.1 * size;
  Hider hider;
  hider.drive = [=, given = 0.0](const Moment& now, MotorPower power) mutable {
    const double mean = 0.5 * (power.right + power.left);
    const double asked = 0.5 * (power.right - power.left);
    if (asked * given < 0.0) given = 0.0;
    const bool winds_up = std::abs(asked) > std::abs(given);
    given = winds_up ? given + std::min(1.0, now.dt / time) * (asked - given) : asked;
    power.left = mean - given;
    power.right = mean + given;
    return power;
  };
  hider.levers = {built("time_of_winding_up", time, "s")};
  hider.equivalent = {built("time", time, "s")};
  return hider;
}

}  // namespace

std::vector<EffectSpec> addedEffects() {
  using K = EffectKind;
  using F = EffectForm;
  using S = EffectShape;
  return {
      {"motor_limit", K::kAdded, F::kPhysical, S::kOther, hideMotorLimit,
       "soft limit of one motor's power in one direction"},
      {"centre_to_side",
       K::kAdded,
       F::kKinematic,
       S::kSame,
       hideCentreToSide,
       "the body turns about a point beside its middle line",
       {"lever_arm_y"}},
      {"yaw_windup", K::kAdded, F::kPhysical, S::kOther, hideYawWindup,
       "power for turning that grows gradually and ends at once"},
  };
}

}  // namespace tread::blind
