// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Effects on turning: resistance of the ground, moments on the body, inertia.
#include <algorithm>
#include <cmath>

#include "tests/study/hide/comparing.hpp"
#include "tests/study/hide/effect_list.hpp"
#include "tests/study/hide/test_field.hpp"

namespace tread::blind {
namespace {

using sim::OutsideForce;

double lostYawRate(const SteadyPair& p) {
  return p.without.omega - p.with.omega;
}

Hider hideTrackWidth(double size, double, Rng&) {
  // Tougher ground at the tracks. Only the scrubbing part of the yaw damping grows.
  const double k = 0.125 * size;
  Hider hider;
  hider.build = [=](double, Build& build) {
    const sim::VehicleParameters vehicle = plainVehicle();
    const double arm = vehicle.gauge / 2.0;
    const double scrub = yawDamping() - forwardDamping() * arm * arm;
    build.surface.scrub_resistance *= 1.0 + k * yawDamping() / scrub;
  };
  hider.levers = {built("yaw_damping_added", k, "1")};
  hider.measure = fitted(
      "k_t", "1", [](const SteadyPair& p) { return p.with.omega; }, lostYawRate);
  return hider;
}

Hider hideYawRateSkid(double size, double, Rng&) {
  const double k = 0.125 * size;
  Hider hider;
  // Earth heaped up at the tracks: resistance with the square of the rate.
  hider.push = [=](const Moment& now) {
    const double omega = now.v_body.omega;
    return OutsideForce{0.0, 0.0, -yawDamping() * k * omega * std::abs(omega)};
  };
  hider.levers = {built("moment_per_squared_rate", yawDamping() * k, "N m s^2")};
  hider.measure = fitted(
      "k_2", "s", [](const SteadyPair& p) { return std::abs(p.without.omega) * p.with.omega; },
      lostYawRate);
  return hider;
}

Hider hideTurnPowerLimit(double size, double, Rng&) {
  const double limit = 1.6 / (1.0 + 0.25 * size);
  Hider hider;
  // Beyond the limit the drive has hardly any moment left: a steep wall, not a hard limit.
  hider.push = [=](const Moment& now) {
    const double beyond = std::max(0.0, std::abs(now.v_body.omega) - limit);
    return OutsideForce{0.0, 0.0, -std::copysign(4.0 * yawDamping() * beyond, now.v_body.omega)};
  };
  hider.levers = {built("rate_where_moment_ends", limit, "rad/s")};
  hider.equivalent = {built("omega_max", limit, "rad/s")};
  return hider;
}

Hider hideYawBreakaway(double size, double, Rng&) {
  const double rate = 0.06 * size;
  constexpr double kCreep = 0.02;  // below it the ground reacts like a spring [rad/s]
  Hider hider;
  hider.push = [=](const Moment& now) {
    return OutsideForce{0.0, 0.0, -yawDamping() * rate * std::tanh(now.v_body.omega / kCreep)};
  };
  hider.levers = {built("dry_moment", yawDamping() * rate, "N m"),
                  built("creep_rate", kCreep, "rad/s")};
  hider.measure = [=](const Comparison& all) {
    return std::vector<Quantity>{
        {"omega_c",
         meanWhere(
             all, [=](const SteadyPair& p) { return std::abs(p.without.omega) - 2.0 * rate; },
             [](const SteadyPair& p) {
               return std::abs(p.without.omega) - std::abs(p.with.omega);
             }),
         "rad/s", true}};
  };
  return hider;
}

Hider hideSpeedUndersteer(double size, double, Rng&) {
  const double k = 0.125 * size;
  Hider hider;
  hider.push = [=](const Moment& now) {
    // Grows faster than the square of the speed.
    const double speed = std::abs(now.v_body.v_x);
    return OutsideForce{0.0, 0.0, -yawDamping() * k * std::pow(speed, 2.5) * now.v_body.omega};
  };
  hider.levers = {built("moment_per_rate_at_1_m_s", yawDamping() * k, "N m s")};
  hider.measure = fitted(
      "K", "s^2/m^2",
      [](const SteadyPair& p) { return p.without.v_x * p.without.v_x * p.with.omega; },
      lostYawRate);
  return hider;
}

Hider hideYawPull(double size, double, Rng& rng) {
  const double k = 0.03 * size * rng.sign();
  const double moment = yawDamping() * k;
  Hider hider;
  // Drag on one side of the vehicle, which turns and brakes.
  hider.push = [=](const Moment& now) {
    const double arm = plainVehicle().gauge / 2.0;
    return OutsideForce{-std::abs(moment) / arm * now.v_body.v_x, 0.0, moment * now.v_body.v_x};
  };
  hider.levers = {built("moment_per_speed", moment, "N s")};
  hider.measure = fitted(
      "k", "rad/m", [](const SteadyPair& p) { return p.with.v_x; },
      [](const SteadyPair& p) { return p.with.omega - p.without.omega; });
  return hider;
}

Hider hideGripLimit(double size, double, Rng&) {
  // From .09 g to .06 g: wet ice. No vehicle can drive on less.
  const double limit = 1.1 / (1.0 + 0.2 * size);
  Hider hider;
  // At the limit of side force the vehicle pushes outwards over its front and turns less.
  hider.push = [=](const Moment& now) {
    const double v = std::max(0.1, std::abs(now.v_body.v_x));
    const double beyond = std::max(0.0, std::abs(v * now.v_body.omega) - limit);
    return OutsideForce{0.0, 0.0,
                        -std::copysign(6.0 * yawDamping() * beyond / v, now.v_body.omega)};
  };
  hider.levers = {built("side_acceleration_where_grip_ends", limit, "m/s^2")};
  hider.equivalent = {built("a_lat", limit, "m/s^2")};
  return hider;
}

Hider hideReverseYawGain(double size, double, Rng& rng) {
  const double k = 0.075 * size * rng.sign();
  Hider hider;
  // Sagging chain: turning is easier in one direction.
  hider.push = [=](const Moment& now) {
    const double speed = std::clamp(now.v_body.v_x, -1.2, 1.2);
    return OutsideForce{0.0, 0.0, yawDamping() * k * speed * now.v_body.omega};
  };
  hider.levers = {built("moment_per_rate_and_speed", yawDamping() * k, "N s^2")};
  hider.measure = fitted(
      "k", "s/m", [](const SteadyPair& p) { return p.without.v_x * p.without.omega; },
      [](const SteadyPair& p) { return p.with.omega - p.without.omega; });
  return hider;
}

Hider hideYawInertia(double size, double, Rng&) {
  const double lag = 0.125 * size;
  Hider hider;
  hider.build = [=](double, Build& build) { build.vehicle.yaw_inertia += lag * yawDamping(); };
  hider.levers = {built("yaw_inertia_added", lag * yawDamping(), "kg m^2")};
  hider.equivalent = {built("tau_w", lag, "s")};
  return hider;
}

}  // namespace

std::vector<EffectSpec> turningEffects() {
  using K = EffectKind;
  using F = EffectForm;
  using S = EffectShape;
  return {
      {"track_width",
       K::kVehicle,
       F::kPhysical,
       S::kSame,
       hideTrackWidth,
       "scrub resistance of the ground",
       {},
       {{"position_scale", "slip_ratio"}}},
      {"yaw_rate_skid", K::kVehicle, F::kPhysical, S::kOther, hideYawRateSkid,
       "moment with the square of the rate"},
      {"turn_power_limit", K::kVehicle, F::kPhysical, S::kOther, hideTurnPowerLimit,
       "steep moment beyond a rate"},
      {"yaw_breakaway", K::kVehicle, F::kPhysical, S::kOther, hideYawBreakaway,
       "dry moment that creeps"},
      {"speed_understeer", K::kVehicle, F::kPhysical, S::kOther, hideSpeedUndersteer,
       "yaw damping with speed to the 2.5"},
      {"yaw_pull", K::kVehicle, F::kPhysical, S::kOther, hideYawPull,
       "one-sided drag: it turns and brakes"},
      {"grip_limit", K::kVehicle, F::kPhysical, S::kOther, hideGripLimit,
       "moment beyond a side acceleration"},
      {"reverse_yaw_gain", K::kVehicle, F::kPhysical, S::kOther, hideReverseYawGain,
       "yaw damping with signed speed"},
      {"yaw_inertia", K::kVehicle, F::kPhysical, S::kSame, hideYawInertia, "yaw inertia"},
  };
}

}  // namespace tread::blind
