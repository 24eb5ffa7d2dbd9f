// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/vehicle/ground_motion.hpp"

#include <algorithm>
#include <cmath>

#include "common/vehicle/dead_zone.hpp"

namespace tread {
namespace {

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
