// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/vehicle/motion_steps.hpp"

#include <algorithm>
#include <cmath>

namespace tread {
namespace {

/// A value without its first `width`: 0 up to there, the rest beyond, sign kept.
double deadZone(double value, double width) {
  const double rest = std::abs(value) - width;
  return rest <= 0.0 ? 0.0 : std::copysign(rest, value);
}

constexpr double kHour = 3600.0;  // [s]

/// Mean speed behind the slack, of which the drive takes up or gives back what it moves.
double behindSlack(double slack, double mean, double dt, TrackState& track) {
  const double moved = mean * dt;
  const double taken = std::clamp(track.taken - moved, 0.0, slack);
  const double passed = moved + (taken - track.taken);
  track.taken = taken;
  return passed / dt;
}

constexpr double kGravity = 9.81;         // [m/s2]
constexpr double kLeastDivisor = 0.1;     // [1], where a negative loss would divide by nothing
constexpr double kSlopeFullSpeed = 0.05;  // [m/s], slower tracks hold on a slope

/// Share of [from, from + dt] that is after `change`.
double shareAfter(double change, double from, double dt) {
  if (from >= change) return 1.0;
  return dt <= 0.0 ? 0.0 : std::clamp((from + dt - change) / dt, 0.0, 1.0);
}

/// `value` over 1 + loss.
double lessened(double value, double loss) {
  return value / std::max(kLeastDivisor, 1.0 + loss);
}

double on(double first, double second, const ChangesInForce& changes) {
  return first * changes.terrain_1 + second * changes.terrain_2;
}

/// Slip ratio, on the speed of either track.
TrackCommand slipped(const EffectValues& effects, const ChangesInForce& changes,
                     const TrackCommand& tracks) {
  const double slip =
      effects.slip_ratio + on(effects.terrain_slip_1, effects.terrain_slip_2, changes);
  if (slip == 0.0) return tracks;
  return {tracks.left * (1.0 - slip), tracks.right * (1.0 - slip)};
}

/// Resistance to turning and the limits of turning.
double turned(const EffectValues& effects, const ChangesInForce& changes, double v, double omega) {
  const double width =
      effects.track_width + on(effects.terrain_width_1, effects.terrain_width_2, changes);
  if (width != 0.0) omega = lessened(omega, width);
  if (effects.yaw_rate_skid != 0.0)
    omega = lessened(omega, effects.yaw_rate_skid * std::abs(omega));
  const double breakaway =
      effects.yaw_breakaway + on(effects.terrain_breakaway_1, effects.terrain_breakaway_2, changes);
  if (breakaway > 0.0) omega = deadZone(omega, breakaway);
  if (std::abs(omega) * effects.turn_power_limit > 1.0)
    omega = std::copysign(1.0 / effects.turn_power_limit, omega);
  if (effects.speed_understeer != 0.0) omega = lessened(omega, effects.speed_understeer * v * v);
  if (effects.reverse_yaw_gain != 0.0) omega *= 1.0 + effects.reverse_yaw_gain * v;
  if (changes.payload != 0.0) omega *= 1.0 + effects.payload_yaw * changes.payload;
  if (std::abs(v * omega) * effects.grip_limit > kGravity)
    omega = std::copysign(kGravity / (effects.grip_limit * std::abs(v)), omega);
  return omega;
}

/// Losses of forward speed in a turn of `omega`.
double slowed(const EffectValues& effects, const ChangesInForce& changes, double v, double omega) {
  if (effects.turn_speed_loss != 0.0) v = lessened(v, effects.turn_speed_loss * std::abs(omega));
  if (effects.reverse_speed_gain != 0.0) v += effects.reverse_speed_gain * std::abs(v);
  if (changes.payload != 0.0) v *= 1.0 + effects.payload_speed * changes.payload;
  if (effects.quadratic_drag != 0.0) v -= effects.quadratic_drag * v * std::abs(v);
  if (effects.rolling_resistance != 0.0) v = deadZone(v, effects.rolling_resistance);
  return v;
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

ChangesInForce changesAt(const EffectValues& effects, double session_time, double dt) {
  ChangesInForce changes;
  if (effects.payload_yaw != 0.0 || effects.payload_speed != 0.0 || effects.payload_icr != 0.0)
    changes.payload = shareAfter(effects.payload_time, session_time, dt);
  const bool first = effects.terrain_slip_1 != 0.0 || effects.terrain_width_1 != 0.0 ||
                     effects.terrain_breakaway_1 != 0.0;
  const bool second = effects.terrain_slip_2 != 0.0 || effects.terrain_width_2 != 0.0 ||
                      effects.terrain_breakaway_2 != 0.0;
  if (!first && !second) return changes;
  const double begun = shareAfter(effects.terrain_time_1, session_time, dt);
  if (effects.terrain_time_2 > effects.terrain_time_1)
    changes.terrain_2 = shareAfter(effects.terrain_time_2, session_time, dt);
  changes.terrain_1 = begun - changes.terrain_2;
  return changes;
}

PlaneMotion groundMotion(const VehicleModel& model, const ExecutionNoise& noise,
                         const ChangesInForce& changes, const TrackCommand& track_speeds) {
  const EffectValues& effects = model.effects;
  const TrackCommand tracks = slipped(effects, changes, track_speeds);
  const double v = model.forward_gain * noise.forward * (tracks.left + tracks.right) / 2.0;
  double omega = model.yaw_gain * noise.yaw * (tracks.right - tracks.left) / model.gauge;
  omega = turned(effects, changes, v, omega);
  if (effects.yaw_pull != 0.0) omega += effects.yaw_pull * v;
  if (effects.yaw_rate_offset != 0.0) omega += effects.yaw_rate_offset;
  return {slowed(effects, changes, v, omega), omega};
}

Twist2 bodyTwist(const EffectValues& effects, double tan_crab, const ChangesInForce& changes,
                 const DriveContext& context, const TrackCommand& track_speeds,
                 const PlaneMotion& motion) {
  Twist2 v_body{motion.v, 0.0, motion.omega};
  const double icr = effects.icr_offset + effects.payload_icr * changes.payload;
  if (icr != 0.0) v_body.v_y -= icr * motion.omega;
  v_body.v_y += motion.v * tan_crab;
  if (effects.centrifugal_drift != 0.0)
    v_body.v_y -= effects.centrifugal_drift * motion.v * motion.omega;
  if (effects.slope_pitch == 0.0 && effects.slope_roll == 0.0) return v_body;
  const double fastest = std::max(std::abs(track_speeds.left), std::abs(track_speeds.right));
  const double pull = kGravity * std::min(1.0, fastest / kSlopeFullSpeed);
  v_body.v_x += effects.slope_pitch * pull * std::sin(context.pitch);  // nose-down is positive
  v_body.v_y -= effects.slope_roll * pull * std::sin(context.roll);
  return v_body;
}

}  // namespace tread
