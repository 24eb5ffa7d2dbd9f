// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Longitudinal and lateral effects on the body: load, slope, drag, ground.
#include <algorithm>
#include <cmath>

#include "tests/study/hide/comparing.hpp"
#include "tests/study/hide/effect_list.hpp"
#include "tests/study/hide/test_field.hpp"

namespace tread::blind {
namespace {

using sim::OutsideForce;

double lostSpeed(const SteadyPair& p) {
  return p.without.v_x - p.with.v_x;
}

double gainedSideSpeed(const SteadyPair& p) {
  return p.with.v_y - p.without.v_y;
}

/// 0 for a standing vehicle, 1 for a moving one: standing tracks hold.
double moving(const Moment& now) {
  const double belt = std::max(std::abs(now.belt_left), std::abs(now.belt_right));
  return belt / (belt + 0.03);
}

Hider hidePayloadChange(double size, double duration, Rng& rng) {
  const double change = duration * rng.uniform(0.35, 0.65);
  // More weight increases the resistance to turning; it is slightly behind or ahead.
  const sim::VehicleParameters plain = plainVehicle();
  const double arm = plain.gauge / 2.0;
  const double scrub_share = 1.0 - forwardDamping() * arm * arm / yawDamping();
  const double gain = 1.0 / (1.0 - 0.1 * std::min(size, 4.0)) - 1.0;
  const double added = plain.mass * gain / scrub_share;
  const double shift = 0.01 * size * rng.sign();
  Hider hider;
  hider.due = {change};
  hider.build = [=](double time, Build& build) {
    if (time < change) return;
    build.vehicle.mass += added;
    build.vehicle.yaw_inertia += added * 0.1;
    build.surface.pressure_offset += shift;
  };
  hider.levers = {built("mass_added", added, "kg"), built("weight_moved_ahead", shift, "m"),
                  built("at", change, "s")};
  hider.measure = [=](const Comparison& all) {
    const auto later = [=](const SteadyPair& p) { return p.time > change ? 1.0 : 0.0; };
    return std::vector<Quantity>{
        {"k",
         slopeOf(
             all, [=](const SteadyPair& p) { return later(p) * p.without.omega; },
             [](const SteadyPair& p) { return p.with.omega - p.without.omega; }),
         "1", true},
        {"T_c", change, "s", false}};
  };
  return hider;
}

Hider hideTerrainChange(double size, double duration, Rng& rng) {
  const int changes = 1 + rng.below(2);
  std::vector<double> at{duration * rng.uniform(0.3, 0.5)};
  if (changes == 2) at.push_back(at.front() + duration * rng.uniform(0.2, 0.35));
  Hider hider;
  hider.due = at;
  if (changes == 2) hider.unlike = {"payload_change"};
  hider.build = [=](double time, Build& build) {
    if (time < at.front() || (changes == 2 && time >= at.back())) return;
    build.surface.scrub_resistance *= 1.0 + 0.2 * size;
    build.surface.resistance_viscous += 0.06 * size;
    build.surface.friction *= 0.9;
  };
  hider.levers = {built("scrub_resistance_added", 0.2 * size, "1"),
                  built("viscous_resistance_added", 0.06 * size, "s/m")};
  for (const double time : at) hider.levers.push_back(built("at", time, "s"));
  hider.measure = [=](const Comparison& all) {
    const auto other = [=](const SteadyPair& p) {
      return p.time > at.front() && (changes == 1 || p.time < at.back()) ? 1.0 : 0.0;
    };
    const double yaw = slopeOf(
        all, [=](const SteadyPair& p) { return other(p) * p.without.omega; },
        [=](const SteadyPair& p) { return p.with.omega - p.without.omega; });
    const double speed = slopeOf(
        all, [=](const SteadyPair& p) { return other(p) * p.without.v_x; },
        [=](const SteadyPair& p) { return p.with.v_x - p.without.v_x; });
    std::vector<Quantity> found{{"yaw_gain_change", yaw, "1", true},
                                {"speed_gain_change", speed, "1", true}};
    for (const double time : at) found.push_back({"T_c", time, "s", false});
    return found;
  };
  return hider;
}

Hider hideSlopePitch(double size, double, Rng&) {
  const double g_p = 0.02 * size;
  // As a share of the body's weight; above 1 it pulls a trailer.
  const double share = g_p * forwardDamping() / plainVehicle().mass;
  Hider hider;
  hider.push = [=](const Moment& now) {
    const double pull = share * plainVehicle().mass * kGravity * std::sin(now.pitch);
    return OutsideForce{moving(now) * pull, 0.0, 0.0};
  };
  hider.levers = {built("share_of_weight", share, "1")};
  hider.measure = fitted(
      "g_p", "s", [](const SteadyPair& p) { return kGravity * std::sin(p.pitch); },
      [](const SteadyPair& p) { return -lostSpeed(p); });
  return hider;
}

Hider hideSlopeRoll(double size, double, Rng&) {
  const double share = 0.02 * size * sideDamping() / plainVehicle().mass;
  Hider hider;
  hider.push = [=](const Moment& now) {
    const double pull = share * plainVehicle().mass * kGravity * std::sin(now.roll);
    return OutsideForce{0.0, -moving(now) * pull, 0.0};
  };
  hider.levers = {built("share_of_weight", share, "1")};
  hider.measure = fitted(
      "g_r", "s", [](const SteadyPair& p) { return -kGravity * std::sin(p.roll); },
      gainedSideSpeed);
  return hider;
}

Hider hideCentrifugalDrift(double size, double, Rng&) {
  const double k = 0.06 * size;
  Hider hider;
  // The ground yields more under higher force.
  hider.push = [=](const Moment& now) {
    const double side = now.v_body.v_x * now.v_body.omega;
    return OutsideForce{0.0, -sideDamping() * k * side * (0.5 + std::min(1.0, std::abs(side))),
                        0.0};
  };
  hider.levers = {built("side_force_per_acceleration", sideDamping() * k, "kg")};
  hider.measure = fitted(
      "k_c", "s", [](const SteadyPair& p) { return -p.without.v_x * p.without.omega; },
      gainedSideSpeed);
  return hider;
}

Hider hideRollingResistance(double size, double, Rng&) {
  const double c = 0.04 * size;
  constexpr double kCreep = 0.01;  // [m/s]
  Hider hider;
  hider.push = [=](const Moment& now) {
    return OutsideForce{-forwardDamping() * c * std::tanh(now.v_body.v_x / kCreep), 0.0, 0.0};
  };
  hider.levers = {built("dry_force", forwardDamping() * c, "N")};
  hider.measure = [=](const Comparison& all) {
    return std::vector<Quantity>{
        {"c",
         meanWhere(
             all, [=](const SteadyPair& p) { return std::abs(p.without.v_x) - 1.5 * c; },
             [](const SteadyPair& p) { return std::abs(p.without.v_x) - std::abs(p.with.v_x); }),
         "m/s", true}};
  };
  return hider;
}

Hider hideQuadraticDrag(double size, double, Rng&) {
  const double k = 0.06 * size;
  Hider hider;
  hider.push = [=](const Moment& now) {
    const double v = now.v_body.v_x;
    return OutsideForce{-forwardDamping() * k * v * std::abs(v), 0.0, 0.0};
  };
  hider.levers = {built("drag", forwardDamping() * k, "N s^2/m^2")};
  hider.measure = fitted(
      "k", "s/m", [](const SteadyPair& p) { return p.without.v_x * std::abs(p.without.v_x); },
      lostSpeed);
  return hider;
}

Hider hideTurnSpeedLoss(double size, double, Rng&) {
  const double k = 0.06 * size;
  Hider hider;
  // Earth carried along sideways: quadratic for small rates, linear for large ones.
  hider.push = [=](const Moment& now) {
    const double omega = std::abs(now.v_body.omega);
    const double turning = 0.9 * omega * omega / (omega + 0.2);
    return OutsideForce{-forwardDamping() * k * turning * now.v_body.v_x, 0.0, 0.0};
  };
  hider.levers = {built("drag_per_rate", forwardDamping() * k, "N s^2/m")};
  hider.measure = fitted(
      "k", "s", [](const SteadyPair& p) { return std::abs(p.without.omega) * p.with.v_x; },
      lostSpeed);
  return hider;
}

Hider hideReverseSpeedGain(double size, double, Rng& rng) {
  const double k = 0.03 * size * rng.sign();
  Hider hider;
  hider.push = [=](const Moment& now) {
    return OutsideForce{forwardDamping() * k * std::abs(now.v_body.v_x), 0.0, 0.0};
  };
  hider.levers = {built("force_per_speed", forwardDamping() * k, "N s/m")};
  hider.measure = fitted(
      "k", "1", [](const SteadyPair& p) { return std::abs(p.without.v_x); },
      [](const SteadyPair& p) { return -lostSpeed(p); });
  return hider;
}

Hider hideIcrOffset(double size, double, Rng& rng) {
  const double wanted = 0.05 * size;
  // The weight shifts the centre of pressure; the rest comes from the tracks.
  const double pressure = std::min(0.2 * wanted, 0.02);
  const double sign = rng.sign();
  Hider hider;
  hider.build = [=](double, Build& build) {
    build.surface.pressure_offset += sign * pressure;
    build.vehicle.centre += sign * (wanted - pressure);
  };
  hider.levers = {built("pressure_ahead", sign * pressure, "m"),
                  built("tracks_ahead", sign * (wanted - pressure), "m")};
  hider.measure = fitted(
      "x_icr", "m", [](const SteadyPair& p) { return -p.with.omega; }, gainedSideSpeed);
  return hider;
}

Hider hideCrab(double size, double, Rng& rng) {
  const double angle = 0.025 * size * rng.sign();
  Hider hider;
  hider.slide = [=](const Moment&, Twist2 twist) {
    twist.v_y += twist.v_x * std::tan(angle);
    return twist;
  };
  hider.levers = {built("angle", angle, "rad")};
  hider.equivalent = {built("psi_0", angle, "rad")};
  return hider;
}

Hider hideBodyInertia(double size, double, Rng&) {
  const double lag = 0.15 * size;
  Hider hider;
  // As much mass would slip on any ground, so the motion itself is delayed.
  hider.slide = [=, v = 0.0](const Moment& now, Twist2 twist) mutable {
    v += (twist.v_x - v) * now.dt / lag;
    twist.v_x = v;
    return twist;
  };
  hider.levers = {built("lag", lag, "s")};
  hider.equivalent = {built("tau_v", lag, "s")};
  return hider;
}

}  // namespace

std::vector<EffectSpec> bodyEffects() {
  using K = EffectKind;
  using F = EffectForm;
  using S = EffectShape;
  return {
      {"payload_change",
       K::kVehicle,
       F::kPhysical,
       S::kOther,
       hidePayloadChange,
       "mass, inertia, centre of pressure at a time",
       {"terrain_change"}},
      {"terrain_change",
       K::kVehicle,
       F::kPhysical,
       S::kOther,
       hideTerrainChange,
       "surface parameters at one or two times",
       {"payload_change"}},
      {"slope_pitch", K::kVehicle, F::kPhysical, S::kSame, hideSlopePitch, "downhill force along"},
      {"slope_roll", K::kVehicle, F::kPhysical, S::kOther, hideSlopeRoll,
       "downhill force across while moving"},
      {"centrifugal_drift",
       K::kVehicle,
       F::kPhysical,
       S::kOther,
       hideCentrifugalDrift,
       "side force, progressive",
       {"heading_latency"}},
      {"rolling_resistance", K::kVehicle, F::kPhysical, S::kSame, hideRollingResistance,
       "dry drag on the body"},
      {"quadratic_drag", K::kVehicle, F::kPhysical, S::kOther, hideQuadraticDrag,
       "drag with the square of the true speed"},
      {"turn_speed_loss", K::kVehicle, F::kPhysical, S::kOther, hideTurnSpeedLoss,
       "drag with the rate, first squared"},
      {"reverse_speed_gain", K::kVehicle, F::kPhysical, S::kOther, hideReverseSpeedGain,
       "push ahead with speed either way"},
      {"icr_offset",
       K::kVehicle,
       F::kPhysical,
       S::kSame,
       hideIcrOffset,
       "centre of pressure and of the tracks",
       {"lever_arm_x"}},
      {"body_inertia", K::kVehicle, F::kKinematic, S::kSame, hideBodyInertia,
       "first-order lag of the body's speed"},
      {"crab",
       K::kVehicleVariant,
       F::kKinematic,
       S::kSame,
       hideCrab,
       "motion at an angle to the hull",
       {"heading_misalignment"}},
  };
}

}  // namespace tread::blind
