// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/vehicle/drive_train.hpp"

#include <algorithm>
#include <cmath>

#include "common/vehicle/dead_zone.hpp"

namespace tread {
namespace {

constexpr double kHour = 3600.0;  // [s]

/// Mean speed behind the slack, of which the drive takes up or gives back what it moves.
double behindSlack(double slack, double mean, double dt, TrackState& track) {
  const double moved = mean * dt;
  const double taken = std::clamp(track.taken - moved, 0.0, slack);
  const double passed = moved + (taken - track.taken);
  track.taken = taken;
  return passed / dt;
}

}  // namespace

Followed follow(double value, double target, double lag, double dt) {
  if (lag <= 0.0) return {target, target};
  const double decay = std::exp(-dt / lag);
  const double distance = value - target;
  return {target + distance * (1.0 - decay) * lag / dt, target + distance * decay};
}

Followed follow(double value, double target, double lag, double inverse_limit, double dt) {
  if (inverse_limit == 0.0) return follow(value, target, lag, dt);
  const double rate = 1.0 / inverse_limit;
  const double sign = target < value ? -1.0 : 1.0;
  const double knee = rate * lag;  // from this distance on the lag is the slower one
  const double ramp = (std::abs(target - value) - knee) / rate;
  if (ramp <= 0.0) return follow(value, target, lag, dt);
  if (ramp >= dt) return {value + sign * rate * dt / 2.0, value + sign * rate * dt};
  const double turn = target - sign * knee;
  const Followed rest = follow(turn, target, lag, dt - ramp);
  return {((value + turn) / 2.0 * ramp + rest.mean * (dt - ramp)) / dt, rest.end};
}

Followed follow(double value, const MovingTarget& target, double lag, double dt) {
  if (lag <= 0.0) return {target.mean, target.to};
  // With s = t / dt the target is from + slope s + bend s^2; what follows it for good is
  // target - lag target' + lag^2 target''.
  const double bend = 3.0 * (target.from + target.to) - 6.0 * target.mean;
  const double slope = target.to - target.from - bend;
  const double share = lag / dt;
  if (share > 1e4) return follow(value, target.mean, lag, dt);  // rounding
  const double bent = 2.0 * share * share * bend;
  const double behind_from = target.from - share * slope + bent;
  const double behind_to = target.to - share * (slope + 2.0 * bend) + bent;
  const double end = behind_to + (value - behind_from) * std::exp(-dt / lag);
  return {target.mean - share * (end - value), end};
}

double suppliedSpeed(const EffectValues& effects, double asked, double session_time, double drop) {
  double speed = asked;
  if (effects.motor_deadband != 0.0) speed = deadZone(speed, effects.motor_deadband);
  if (std::abs(speed) * effects.speed_saturation > 1.0)
    speed = std::copysign(1.0 / effects.speed_saturation, speed);
  if (effects.battery_sag_per_hour != 0.0)
    speed *= std::max(0.0, 1.0 - effects.battery_sag_per_hour * session_time / kHour);
  if (effects.battery_sag_per_drop != 0.0)
    speed *= std::max(0.0, 1.0 - effects.battery_sag_per_drop * drop);
  return speed;
}

double driveTarget(const EffectValues& effects, double supplied, double side, double heat) {
  double target = supplied;
  if (effects.thermal_derating != 0.0)
    target *= std::max(0.0, 1.0 - effects.thermal_derating * heat);
  if (effects.track_asymmetry != 0.0) target *= 1.0 + side * effects.track_asymmetry;
  return target;
}

double driveTrack(const VehicleModel& model, double supplied, double side, double dt,
                  TrackState& track) {
  const EffectValues& effects = model.effects;
  const double target = driveTarget(effects, supplied, side, track.heat);
  double lag = model.driveLag();
  if (effects.lag_asymmetry != 0.0 &&
      (std::abs(target) < std::abs(track.speed) || target * track.speed < 0.0))
    lag = std::max(0.0, lag + effects.lag_asymmetry);
  const Followed speed = follow(track.speed, target, lag, effects.slew_limit, dt);
  track.speed = speed.end;
  if (effects.thermal_derating != 0.0) {
    const double duty = supplied / model.full_speed;
    track.heat = follow(track.heat, duty * duty, effects.thermal_time, dt).end;
  }
  if (effects.track_backlash == 0.0) return speed.mean;
  return behindSlack(effects.track_backlash, speed.mean, dt, track);
}

}  // namespace tread
