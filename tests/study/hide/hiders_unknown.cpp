// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Effects that no catalogue lists.
#include <algorithm>
#include <cmath>
#include <deque>

#include "tests/study/hide/effect_list.hpp"
#include "tests/study/hide/test_field.hpp"

namespace tread::blind {
namespace {

using sim::MotorPower;
using sim::OutsideForce;

Hider hideStribeckFriction(double size, double, Rng&) {
  const double loss = 0.05 * size;  // of power in a slow gear [1]
  constexpr double kFadingSpeed = 0.25;
  Hider hider;
  hider.stage = Stage::kMotor;
  hider.drive = [=](const Moment& now, MotorPower power) {
    const auto rubbed = [=](double p, double belt) {
      const double ratio = belt / kFadingSpeed;
      const double dry = loss * std::exp(-ratio * ratio);
      return std::copysign(std::max(0.0, std::abs(p) - dry), p);
    };
    return MotorPower{rubbed(power.left, now.belt_left), rubbed(power.right, now.belt_right)};
  };
  hider.levers = {{"power_lost_when_slow", loss, "1", false},
                  {"fading_speed", kFadingSpeed, "m/s", false}};
  return hider;
}

Hider hideLoadTransfer(double size, double, Rng&) {
  const double k = 0.25 * size;
  Hider hider;
  // Braking loads the front of the tracks and frees their rear: turning gets easier, and the tail
  // swings out; accelerating does the opposite.
  hider.push = [=, slow = 0.0](const Moment& now) mutable {
    constexpr double kSettling = 0.15;  // of the suspension [s]
    const double rate = (now.v_body.v_x - slow) / kSettling;
    slow += now.dt * rate;
    // The track that is lifted off can take no more than most of the resistance away.
    const double share = std::clamp(k * std::copysign(1.0, now.v_body.v_x) * rate, -0.7, 0.7);
    const double omega = now.v_body.omega;
    return OutsideForce{0.0, sideDamping() * 0.1 * share * omega, -yawDamping() * share * omega};
  };
  hider.levers = {{"yaw_damping_per_acceleration", k, "s^2/m", false}};
  return hider;
}

Hider hideVoltageDeadTime(double size, double, Rng&) {
  constexpr double kPerVolt = 0.2;         // [s/V]
  const double resistance = 0.014 * size;  // of old cables [ohm]
  Hider hider;
  hider.stage = Stage::kWire;
  hider.build = [=](double, Build& build) { build.vehicle.drive.inner_resistance += resistance; };
  // A controller that answers late while the voltage is low.
  hider.drive = [=, wire = std::deque<MotorPower>(), low = 0.0](const Moment& now,
                                                                MotorPower power) mutable {
    constexpr double kSlow = 1.0;  // [s]
    const sim::DriveParameters plain = plainVehicle().drive;
    const double share = resistance / (resistance + plain.inner_resistance);
    const double missing = share * std::max(0.0, plain.full_voltage - now.voltage);
    low += (missing - low) * now.dt / kSlow;
    wire.push_back(power);
    const auto wanted = static_cast<size_t>(std::min(0.4, kPerVolt * low) / now.dt) + 1;
    while (wire.size() > wanted) wire.pop_front();
    return wire.front();
  };
  hider.levers = {{"dead_time_per_missing_voltage", kPerVolt, "s/V", false},
                  {"resistance_added", resistance, "ohm", false}};
  return hider;
}

Hider hideSteeringHysteresis(double size, double, Rng&) {
  const double k = 0.1 * size;
  constexpr double kSeating = 0.8;  // [rad]
  Hider hider;
  // Earth lies against the side that the last turn left it on: the next turn the same way is
  // easier, one the other way harder.
  hider.push = [=, seated = 0.0](const Moment& now) mutable {
    const double turn = now.v_body.omega * now.dt;
    seated += (turn - seated * std::abs(turn)) / kSeating;
    return OutsideForce{0.0, 0.0, yawDamping() * k * seated * std::abs(now.v_body.omega)};
  };
  hider.levers = {{"yaw_gain_either_way", k, "1", false}, {"seating", kSeating, "rad", false}};
  return hider;
}

}  // namespace

std::vector<EffectSpec> unknownEffects() {
  using K = EffectKind;
  using F = EffectForm;
  using S = EffectShape;
  return {
      {"stribeck_friction",
       K::kOutOfCatalogue,
       F::kPhysical,
       S::kOther,
       hideStribeckFriction,
       "gear friction that fades with speed",
       {},
       {},
       {"speed", "command"}},
      {"load_transfer",
       K::kOutOfCatalogue,
       F::kPhysical,
       S::kOther,
       hideLoadTransfer,
       "yaw damping and side force with braking",
       {},
       {},
       {"acceleration", "time_since_command", "previous_command"}},
      {"voltage_dead_time",
       K::kOutOfCatalogue,
       F::kPhysical,
       S::kOther,
       hideVoltageDeadTime,
       "queue that grows with missing voltage",
       {},
       {},
       {"voltage", "time_since_command"}},
      {"steering_hysteresis",
       K::kOutOfCatalogue,
       F::kPhysical,
       S::kOther,
       hideSteeringHysteresis,
       "yaw damping by the turns before",
       {},
       {},
       {"previous_turn", "previous_command"}},
  };
}

}  // namespace tread::blind
