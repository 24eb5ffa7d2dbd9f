// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Effects of battery, power stage, motor and gear, which change the power on its way to the
// motor.
#include <algorithm>
#include <cmath>
#include <deque>

#include "tests/study/hide/comparing.hpp"
#include "tests/study/hide/effect_list.hpp"
#include "tests/study/hide/test_field.hpp"

namespace tread::blind {
namespace {

using sim::MotorPower;

/// Approximate track speed per power of the plain vehicle [m/s].
double speedPerPower() {
  const sim::DriveParameters drive = plainVehicle().drive;
  return drive.free_speed * drive.full_voltage / drive.nominal_voltage * 2.0 * drive.stiffness /
         forwardDamping();
}

template <class Change>
MotorPower each(const MotorPower& power, Change change) {
  return {change(power.left), change(power.right)};
}

/// First-order lag of one track's power.
double follow(double& state, double wanted, double lag, double dt) {
  state += (wanted - state) * std::min(1.0, dt / lag);
  return state;
}

Hider hideSlipRatio(double size, double, Rng&) {
  const double slip = 0.05 * size;
  Hider hider;
  hider.build = [=](double, Build& build) { build.vehicle.drive.free_speed *= 1.0 - slip; };
  hider.levers = {built("lost_share_of_belt_speed", slip, "1")};
  hider.measure = fitted(
      "s", "1", [](const SteadyPair& p) { return p.without.v_x; },
      [](const SteadyPair& p) { return p.without.v_x - p.with.v_x; });
  return hider;
}

Hider hideTrackAsymmetry(double size, double, Rng& rng) {
  const double e = 0.02 * size * rng.sign();
  Hider hider;
  hider.drive = [=](const Moment&, MotorPower power) {
    return MotorPower{power.left * (1.0 + e), power.right * (1.0 - e)};
  };
  hider.levers = {built("left_power_gain", e, "1"), built("right_power_gain", -e, "1")};
  hider.equivalent = {built("e", e, "1")};
  return hider;
}

Hider hideMotorDeadband(double size, double, Rng&) {
  const double dead = 0.05 * size / speedPerPower();
  Hider hider;
  hider.stage = Stage::kSignal;
  hider.drive = [=](const Moment&, MotorPower power) {
    return each(power,
                [=](double p) { return std::copysign(std::max(0.0, std::abs(p) - dead), p); });
  };
  hider.levers = {built("dead_power", dead, "1")};
  hider.equivalent = {built("d", dead * speedPerPower(), "m/s")};
  return hider;
}

Hider hideSpeedSaturation(double size, double, Rng&) {
  const double limit = 1.0 / (1.0 + 0.215 * size);
  Hider hider;
  hider.drive = [=](const Moment&, MotorPower power) {
    // Soft: it weakens within the last tenth before the limit.
    return each(power, [=](double p) {
      return p / std::pow(1.0 + std::pow(std::abs(p) / limit, 10.0), 0.1);
    });
  };
  hider.levers = {built("power_limit", limit, "1")};
  hider.equivalent = {built("u_max", limit * speedPerPower(), "m/s")};
  return hider;
}

Hider hideActuatorLag(double size, double, Rng&) {
  const double more = 0.15 * size;
  Hider hider;
  hider.build = [=](double, Build& build) { build.vehicle.drive.power_lag += more; };
  hider.levers = {built("power_lag_added", more, "s")};
  hider.equivalent = {built("tau", more, "s")};
  return hider;
}

Hider hideCommandDelay(double size, double, Rng&) {
  const double delay = 0.075 * size;
  Hider hider;
  hider.stage = Stage::kWire;
  hider.drive = [=, wire = std::deque<MotorPower>()](const Moment& now, MotorPower power) mutable {
    wire.push_back(power);
    if (static_cast<double>(wire.size()) * now.dt <= delay) return MotorPower{};
    const MotorPower late = wire.front();
    wire.pop_front();
    return late;
  };
  hider.levers = {built("delay", delay, "s")};
  hider.equivalent = {built("T_d", delay, "s")};
  return hider;
}

Hider hideSlewLimit(double size, double, Rng&) {
  const double rate = 2.0 / size / speedPerPower();
  Hider hider;
  hider.stage = Stage::kRamp;
  hider.drive = [=, held = MotorPower{}](const Moment& now, MotorPower power) mutable {
    const double most = rate * now.dt;
    held.left += std::clamp(power.left - held.left, -most, most);
    held.right += std::clamp(power.right - held.right, -most, most);
    return held;
  };
  hider.levers = {built("power_rate", rate, "1/s")};
  hider.equivalent = {built("a_max", rate * speedPerPower(), "m/s^2")};
  return hider;
}

Hider hideLagAsymmetry(double size, double, Rng&) {
  const double more = 0.125 * size;
  const double lag = plainVehicle().drive.power_lag;
  Hider hider;
  hider.stage = Stage::kMotor;
  hider.build = [](double, Build& build) { build.vehicle.drive.power_lag = 0.001; };
  hider.drive = [=, state = MotorPower{}](const Moment& now, MotorPower power) mutable {
    const auto follower = [&](double& p, double wanted) {
      const bool slowing = wanted * p < 0.0 || std::abs(wanted) < std::abs(p);
      return follow(p, wanted, slowing ? lag + more : lag, now.dt);
    };
    follower(state.left, power.left);
    follower(state.right, power.right);
    return state;
  };
  hider.levers = {built("slowing_lag_added", more, "s")};
  hider.equivalent = {built("d_tau", more, "s")};
  return hider;
}

Hider hideBatterySag(double size, double duration, Rng&) {
  const double sag = 0.075 * size;
  // Mean of |power| over both tracks in a random programme: makes the loss end near `sag`.
  constexpr double kMeanPower = 0.31;
  Hider hider;
  // Charge falls with consumption, and the voltage faster towards the end.
  hider.touch = [=, used = 0.0](const Moment& now, sim::TrackedVehicle& vehicle) mutable {
    const double power = 0.5 * (std::abs(now.order.left) + std::abs(now.order.right));
    used += power * now.dt / (kMeanPower * duration);
    vehicle.setCharge(std::max(0.0, 1.0 - (0.8 * used + 0.2 * used * used * used)));
  };
  hider.build = [=](double, Build& build) {
    build.vehicle.drive.empty_voltage = build.vehicle.drive.full_voltage * (1.0 - sag);
  };
  hider.levers = {built("voltage_lost", sag, "1")};
  hider.measure = [](const Comparison& all) {
    return std::vector<Quantity>{
        {"s",
         slopeOf(
             all, [&](const SteadyPair& p) { return p.time / all.duration * p.without.v_x; },
             [](const SteadyPair& p) { return p.without.v_x - p.with.v_x; }),
         "1", true}};
  };
  return hider;
}

Hider hideThermalDerating(double size, double, Rng&) {
  const double h = 0.15 * size;
  constexpr double kHeatingTime = 180.0;  // [s]
  constexpr double kFullCurrent = 40.0;   // of a motor in a tight turn [A]
  Hider hider;
  // Motors warm up with commands and current.
  hider.drive = [=, heat = 0.0](const Moment& now, MotorPower power) mutable {
    const double order =
        0.5 * (now.order.left * now.order.left + now.order.right * now.order.right);
    const double current =
        (now.current_left * now.current_left + now.current_right * now.current_right) /
        (2.0 * kFullCurrent * kFullCurrent);
    const double source = 0.8 * order + 0.2 * std::min(1.0, current);
    heat += (source - heat) * now.dt / kHeatingTime;
    return each(power, [&](double p) { return p * (1.0 - h * heat); });
  };
  hider.levers = {built("loss_per_heat", h, "1"), built("heating_time", kHeatingTime, "s")};
  hider.measure = fitted(
      "h", "1", [](const SteadyPair& p) { return p.duty * p.without.v_x; },
      [](const SteadyPair& p) { return p.without.v_x - p.with.v_x; });
  return hider;
}

/// Gear with slack: the motor turns freely until the slack is taken up.
struct Slack {
  double width = 0.0;  // [m]
  double at = 0.0;     // 0: pulls backwards, width: pulls forwards [m]

  double pass(double power, double belt, double full_speed, double dt) {
    const double free_run = full_speed * power - belt;
    at = std::clamp(at + free_run * dt, 0.0, width);
    const bool engaged = (free_run >= 0.0 && at >= width) || (free_run <= 0.0 && at <= 0.0);
    // Not engaged: the power for which the motor neither pushes nor brakes.
    return engaged ? power : belt / full_speed;
  }
};

Hider hideTrackBacklash(double size, double, Rng&) {
  const double width = 0.025 * size;
  const sim::DriveParameters drive = plainVehicle().drive;
  const double full_speed = drive.free_speed * drive.full_voltage / drive.nominal_voltage;
  Hider hider;
  hider.stage = Stage::kMotor;
  hider.build = [](double, Build& build) { build.vehicle.drive.power_lag = 0.001; };
  hider.drive = [=, state = MotorPower{}, left = Slack{width, 0.0}, right = Slack{width, 0.0}](
                    const Moment& now, MotorPower power) mutable {
    follow(state.left, power.left, drive.power_lag, now.dt);
    follow(state.right, power.right, drive.power_lag, now.dt);
    return MotorPower{left.pass(state.left, now.belt_left, full_speed, now.dt),
                      right.pass(state.right, now.belt_right, full_speed, now.dt)};
  };
  hider.levers = {built("slack", width, "m")};
  hider.equivalent = {built("beta", width, "m")};
  return hider;
}

}  // namespace

std::vector<EffectSpec> driveEffects() {
  using K = EffectKind;
  using F = EffectForm;
  using S = EffectShape;
  return {
      {"slip_ratio",
       K::kVehicle,
       F::kPhysical,
       S::kSame,
       hideSlipRatio,
       "belt speed per motor speed",
       {"forward_gain", "full_speed"},
       {{"position_scale", "track_width"}}},
      {"track_asymmetry", K::kVehicle, F::kPhysical, S::kSame, hideTrackAsymmetry,
       "power of the left and right stage"},
      {"motor_deadband", K::kVehicle, F::kPhysical, S::kSame, hideMotorDeadband,
       "dead power of each stage"},
      {"speed_saturation", K::kVehicle, F::kPhysical, S::kOther, hideSpeedSaturation,
       "soft limit of power"},
      {"actuator_lag", K::kVehicle, F::kPhysical, S::kSame, hideActuatorLag,
       "lag of the power stage"},
      {"command_delay",
       K::kVehicle,
       F::kPhysical,
       S::kSame,
       hideCommandDelay,
       "queue before the power stage",
       {"ins_latency"}},
      {"slew_limit", K::kVehicle, F::kPhysical, S::kOther, hideSlewLimit,
       "ramp of power before the lag"},
      {"lag_asymmetry", K::kVehicle, F::kPhysical, S::kSame, hideLagAsymmetry,
       "lag of falling power"},
      {"battery_sag", K::kVehicle, F::kPhysical, S::kOther, hideBatterySag,
       "voltage that falls with what is drawn"},
      {"thermal_derating", K::kVehicle, F::kPhysical, S::kOther, hideThermalDerating,
       "motors heated by orders and current"},
      {"track_backlash", K::kVehicle, F::kPhysical, S::kOther, hideTrackBacklash,
       "slack between motor and belt"},
  };
}

}  // namespace tread::blind
