// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Effects that are not in any catalogue.
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
  // Braking loads the front of the tracks and unloads the rear: turning gets easier, and the tail
  // swings out; accelerating does the opposite.
  hider.push = [=, slow = 0.0](const Moment& now) mutable {
    constexpr double kSettling = 0.15;  // of the suspension [s]
    const double rate = (now.v_body.v_x - slow) / kSettling;
    slow += now.dt * rate;
    // Lifting a track can remove at most most of its resistance.
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
  // A controller that is slower at low voltage.
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
  // Earth remains at the side after a turn: the next turn in the same direction is easier, in the
  // other direction harder.
  hider.push = [=, seated = 0.0](const Moment& now) mutable {
    const double turn = now.v_body.omega * now.dt;
    seated += (turn - seated * std::abs(turn)) / kSeating;
    return OutsideForce{0.0, 0.0, yawDamping() * k * seated * std::abs(now.v_body.omega)};
  };
  hider.levers = {{"yaw_gain_either_way", k, "1", false}, {"seating", kSeating, "rad", false}};
  return hider;
}

/// Power of each track as a function of its earlier commands.
template <class EachTrack>
Hider onTracks(EachTrack left) {
  Hider hider;
  hider.stage = Stage::kMotor;
  hider.drive = [left, right = left](const Moment& now, MotorPower power) mutable {
    return MotorPower{left(now, power.left, power.right, now.belt_left),
                      right(now, power.right, power.left, now.belt_right)};
  };
  return hider;
}

Hider hideInnerTrackStall(double size, double, Rng&) {
  const double least = 0.14 * size;  // of power [1]
  Hider hider = onTracks([=](const Moment&, double own, double other, double) {
    const bool inner = std::abs(own) < std::abs(other) - 0.1;
    return inner && std::abs(own) < least ? 0.0 : own;
  });
  hider.levers = {{"inner_track_stalls_below", least, "1", false}};
  return hider;
}

Hider hideReversalPause(double size, double, Rng&) {
  const double pause = 0.12 * size;  // [s] for switching relays
  Hider hider =
      onTracks([=, sense = 0.0, left = 0.0](const Moment& now, double own, double, double) mutable {
        left -= now.dt;
        if (std::abs(own) > 0.02) {
          const double wanted = own > 0.0 ? 1.0 : -1.0;
          if (wanted * sense < 0.0) left = pause;
          sense = wanted;
        }
        return left > 0.0 ? 0.0 : own;
      });
  hider.levers = {{"pause_at_reversal", pause, "s", false}};
  return hider;
}

Hider hideSlowToAccelerate(double size, double, Rng&) {
  const double time = 0.2 * size;  // [s] for rising power; it falls at once
  Hider hider = onTracks([=, given = 0.0](const Moment& now, double own, double, double) mutable {
    const bool grows = own * given >= 0.0 && std::abs(own) > std::abs(given);
    given = grows ? given + now.dt / time * (own - given) : own;
    return given;
  });
  hider.levers = {{"time_of_growing_power", time, "s", false}};
  return hider;
}

Hider hideSinkageAtRest(double size, double, Rng&) {
  const double loss = 0.12 * size;  // of power, after standing
  constexpr double kStands = 0.05;  // [m/s]
  constexpr double kSinking = 0.7;  // [s]
  constexpr double kOut = 0.35;     // [m] of driving until it is free
  Hider hider =
      onTracks([=, sunk = 0.0](const Moment& now, double own, double, double belt) mutable {
        sunk += std::abs(belt) < kStands ? (1.0 - sunk) * now.dt / kSinking
                                         : -sunk * std::abs(belt) * now.dt / kOut;
        return std::copysign(std::max(0.0, std::abs(own) - loss * sunk), own);
      });
  hider.levers = {{"power_lost_after_rest", loss, "1", false}, {"way_out", kOut, "m", false}};
  return hider;
}

Hider hideSharedCurrentLimit(double size, double, Rng&) {
  const double most = 1.5 / (1.0 + 0.15 * size);  // both powers together [1]
  Hider hider;
  hider.stage = Stage::kMotor;
  hider.drive = [=](const Moment&, MotorPower power) {
    const double sum = std::abs(power.left) + std::abs(power.right);
    const double share = sum > most ? most / sum : 1.0;
    return MotorPower{power.left * share, power.right * share};
  };
  hider.levers = {{"both_powers_at_most", most, "1", false}};
  return hider;
}

Hider hideCastingTail(double size, double, Rng&) {
  const double k = 0.16 * size;
  constexpr double kSettling = 0.4;  // [s] of a swinging tail
  Hider hider;
  hider.push = [=, swung = 0.0](const Moment& now) mutable {
    swung += now.dt / kSettling * (now.v_body.omega - swung);
    // A towed weight continues to turn when the vehicle stops turning, and resists when it begins.
    return OutsideForce{0.0, 0.0, yawDamping() * k * (swung - now.v_body.omega)};
  };
  hider.levers = {{"tail_over_yaw_damping", k, "1", false}, {"settling", kSettling, "s", false}};
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
      {"inner_track_stall",
       K::kOutOfCatalogue,
       F::kPhysical,
       S::kOther,
       hideInnerTrackStall,
       "an inner track that stands still when it gets little power",
       {},
       {},
       {"command"}},
      {"reversal_pause",
       K::kOutOfCatalogue,
       F::kPhysical,
       S::kOther,
       hideReversalPause,
       "no power for a while after each reversal of a track",
       {},
       {},
       {"previous_command", "time_since_command"}},
      {"slow_to_accelerate",
       K::kOutOfCatalogue,
       F::kPhysical,
       S::kOther,
       hideSlowToAccelerate,
       "power that grows slowly and falls at once",
       {},
       {},
       {"acceleration", "time_since_command"}},
      {"sinkage_at_rest",
       K::kOutOfCatalogue,
       F::kPhysical,
       S::kOther,
       hideSinkageAtRest,
       "power lost on the first half metre after standing",
       {},
       {},
       {"time_since_command", "previous_command"}},
      {"shared_current_limit",
       K::kOutOfCatalogue,
       F::kPhysical,
       S::kOther,
       hideSharedCurrentLimit,
       "the sum of both powers is limited",
       {},
       {},
       {"speed", "command"}},
      {"casting_tail",
       K::kOutOfCatalogue,
       F::kPhysical,
       S::kOther,
       hideCastingTail,
       "a towed weight that swings behind",
       {},
       {},
       {"acceleration", "time_since_command", "previous_command"}},
  };
}

}  // namespace tread::blind
