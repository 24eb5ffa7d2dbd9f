// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <array>
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include "common/geometry/se2.hpp"
#include "common/pattern/pattern.hpp"
#include "common/vehicle/omni_wheels.hpp"
#include "common/vehicle/unnamed_terms.hpp"

// A vehicle on one ground: its numbers, the values of its effects, and their influence on a motion.
// A new vehicle effect needs a value and a line in this file, and an entry in the catalogue.
namespace tread {

inline constexpr size_t kMostAdded = 32;  ///< parameters of all added effects

/// Values of the parameters of all vehicle effects, in the order in which they act; 0 = off.
/** What each one means, its unit and its bounds stand in the catalogue (effects.hpp). Limits are
 * held as their reciprocals, so that no limit is 0 and small values are weak effects. What happens
 * to a command, each effect where it acts:
 *
 *     command
 *       -> waits: delay + command_delay
 *       -> each track: full_speed, motor_deadband, speed_saturation, battery_sag,
 *          thermal_derating, track_asymmetry, left_track_loss, right_track_loss
 *       -> added effects of tracks (added_effects.hpp)
 *       -> the drive follows: slew_limit, then lag + actuator_lag (lag_asymmetry when slowing);
 *          track_backlash
 *     a car's steering angle -> the servo follows: steering_rate, then lag + slow_steering
 *       -> steering_play, gain + steering_ratio, steering_offset, steering_limit
 *     track speeds on the ground
 *       -> slip_ratio, terrain_change (slip), gains and gauge of the nominal model
 *       -> yaw rate: track_width and terrain_change (width), yaw_rate_skid, yaw_breakaway and
 *          terrain_change (break-away), turn_power_limit, speed_understeer, reverse_yaw_gain,
 *          payload_change, grip_limit, yaw_pull, yaw_rate_offset
 *       -> forward speed: turn_speed_loss, reverse_speed_gain, payload_change, quadratic_drag,
 *          rolling_resistance
 *       -> the body follows: yaw_inertia, body_inertia
 *       -> unnamed terms, see VehicleModel::unnamed, and added effects of the motion
 *       -> to the side: icr_offset and payload_change, crab, centrifugal_drift
 *       -> slope_pitch, slope_roll
 *     body twist -> pose */
struct EffectValues {
  // How the drive responds to a command, per track.
  double command_delay = 0.0;         ///< [s], added to the model's delay
  double motor_deadband = 0.0;        ///< [m/s]
  double speed_saturation = 0.0;      ///< [s/m], 1 / top speed
  double battery_sag_per_hour = 0.0;  ///< [1/h]
  double battery_sag_per_drop = 0.0;  ///< [1]
  double thermal_derating = 0.0;      ///< [1]
  double thermal_time = 240.0;        ///< [s], shape
  double track_asymmetry = 0.0;       ///< [1]
  double left_track_loss = 0.0;       ///< [1]
  double right_track_loss = 0.0;      ///< [1]
  double actuator_lag = 0.0;          ///< [s], added to the model's lag
  double lag_asymmetry = 0.0;         ///< [s]
  double slew_limit = 0.0;            ///< [s2/m], 1 / greatest acceleration
  double track_backlash = 0.0;        ///< [m]
  // Of a car's steering.
  double steering_ratio = 0.0;   ///< [1], added to the model's gain
  double steering_offset = 0.0;  ///< [rad]
  double slow_steering = 0.0;    ///< [s], added to the model's lag of steering
  double steering_rate = 0.0;    ///< [s/rad], 1 / greatest rate
  double steering_limit = 0.0;   ///< [1/rad], 1 / greatest angle
  double steering_play = 0.0;    ///< [rad]
  // Of the wheels of a holonomic base, in their order.
  double wheel_1_loss = 0.0;  ///< [1]
  double wheel_2_loss = 0.0;  ///< [1]
  double wheel_3_loss = 0.0;  ///< [1]
  double wheel_4_loss = 0.0;  ///< [1]
  // How the ground changes the motion of the tracks.
  double slip_ratio = 0.0;           ///< [1]
  double terrain_time_1 = 0.0;       ///< [s], shape
  double terrain_time_2 = 0.0;       ///< [s], shape
  double terrain_slip_1 = 0.0;       ///< [1]
  double terrain_width_1 = 0.0;      ///< [1]
  double terrain_breakaway_1 = 0.0;  ///< [rad/s]
  double terrain_slip_2 = 0.0;       ///< [1]
  double terrain_width_2 = 0.0;      ///< [1]
  double terrain_breakaway_2 = 0.0;  ///< [rad/s]
  double track_width = 0.0;          ///< [1]
  double yaw_rate_skid = 0.0;        ///< [s]
  double yaw_breakaway = 0.0;        ///< [rad/s]
  double turn_power_limit = 0.0;     ///< [s/rad], 1 / greatest yaw rate
  double turn_power_beyond = 0.0;    ///< [1], shape: share of the excess that still takes effect
  double speed_understeer = 0.0;     ///< [s2/m2]
  double reverse_yaw_gain = 0.0;     ///< [s/m]
  double payload_yaw = 0.0;          ///< [1]
  double payload_speed = 0.0;        ///< [1]
  double payload_icr = 0.0;          ///< [m]
  double payload_time = 0.0;         ///< [s], shape
  double grip_limit = 0.0;           ///< [1], 1 / friction
  double grip_beyond = 0.0;          ///< [1], shape: share of the excess that still takes effect
  double yaw_pull = 0.0;             ///< [rad/m]
  double yaw_rate_offset = 0.0;      ///< [rad/s]
  double turn_speed_loss = 0.0;      ///< [s]
  double reverse_speed_gain = 0.0;   ///< [1]
  double quadratic_drag = 0.0;       ///< [s/m]
  double rolling_resistance = 0.0;   ///< [m/s]
  // The body.
  double yaw_inertia = 0.0;        ///< [s]
  double body_inertia = 0.0;       ///< [s]
  double icr_offset = 0.0;         ///< [m]
  double crab = 0.0;               ///< [rad]
  double centrifugal_drift = 0.0;  ///< [s]
  double slope_pitch = 0.0;        ///< [s]
  double slope_roll = 0.0;         ///< [s]
  // Of the lateral motion of a holonomic base.
  double translation_loss = 0.0;  ///< [1]
  double sideways_loss = 0.0;     ///< [1], subtracted from the model's gain
  double sideways_lag = 0.0;      ///< [s]
  double sideways_turn = 0.0;     ///< [rad/m]
  // What files describe.
  std::array<double, kMostAdded> added{};
};

/// How much executions on the same ground vary: standard deviations.
struct ExecutionSpread {
  double forward = 0.0;  ///< [1] of the factor on the forward speed
  double yaw = 0.0;      ///< [1] of the factor on the yaw rate
  double crab = 0.0;     ///< [rad] of the direction of travel
};

/// Random deviation of one execution; the default is the mean.
struct ExecutionNoise {
  double forward = 1.0;  ///< [1] factor on the forward speed
  double yaw = 1.0;      ///< [1] factor on the yaw rate
  double crab = 0.0;     ///< [rad] added to the direction of travel
};

/// Conditions at one instant of a drive besides the command; default: level, at the start.
/** Frames: x forward, y left, z up; pitch is positive nose down, roll positive left side up. */
struct DriveContext {
  double session_time = 0.0;  ///< [s] since the start of the session
  double battery_drop = 0.0;  ///< [1] relative drop of the voltage since then; 0 = not measured
  double roll = 0.0;          ///< [rad]
  double pitch = 0.0;         ///< [rad]
};

/// A vehicle on one ground: nominal two-track model and the effects that are on.
/** A car is modelled by its two rear wheels: both follow the throttle, and by Ackermann's law the
 * steered front wheels make one run faster than the other (rearWheels()); the effects act on them
 * as on tracks. Its commands are throttle or speed, and steering angle, in the places of left and
 * right.
 *
 * v_x = forward_gain (vl + vr) / 2, omega = yaw_gain (vr - vl) / gauge, v_y = 0; track speeds
 * follow the commands after a delay with a first-order lag; then the effects act.
 *
 * A holonomic base has wheels, and a kernel of its own (omni_kernel.hpp). */
struct VehicleModel {
  std::string name;
  CommandKind kind = CommandKind::kPower;
  double full_speed = 1.0;  ///< [m/s] track speed at power 1; unused for track speed commands
  double lag = 0.0;         ///< [s] time constant of the track speeds
  double delay = 0.0;       ///< [s] before a command begins to act
  double gauge = 1.0;       ///< [m] between the middles of the tracks, of a car's rear wheels
  double wheelbase = 0.0;   ///< [m] of a car, whose body origin is on its rear axle; 0 = two tracks
  double steering_gain = 1.0;  ///< [1] of a car: ratio of the wheels' angle to the commanded one
  double steering_lag = 0.0;   ///< [s] time constant of a car's steering
  double forward_gain = 1.0;   ///< [1] ratio of ground speed to mean track speed
  double yaw_gain = 1.0;       ///< [1] ratio of yaw rate to that of the track speeds
  OmniWheels wheels;           ///< of a holonomic base; otherwise empty
  double sideways_gain = 1.0;  ///< [1] of a holonomic base: ratio of ground speed to rim speed
  double step = 0.005;         ///< [s] longest integration step
  EffectValues effects;
  /// Terms outside the catalogue's effects; each depends on the motion without any of them.
  std::vector<UnnamedTerm> unnamed;
  ExecutionSpread spread;

  bool isCar() const { return wheelbase > 0.0; }
  bool isOmni() const { return !wheels.empty(); }
  VehicleLayout layout() const {
    return isOmni() ? VehicleLayout::kOmni : isCar() ? VehicleLayout::kCar : VehicleLayout::kTracks;
  }
  /// The channels of its commands, each with its full range.
  CommandChannels channels() const {
    if (isOmni()) return omniChannels(kind, wheels.size());
    return isCar() ? carChannels(kind) : trackChannels(kind);
  }
  /// Track speeds that a command asks for, left and right [m/s]; of a car, those of its drive
  /// wheels.
  TrackCommand trackSpeeds(const TrackCommand& command) const {
    return {unit() * command.left, unit() * (isCar() ? command.left : command.right)};
  }
  /// Speed for a command of 1 [m/s].
  double unit() const { return kind == CommandKind::kTrackSpeed ? 1.0 : full_speed; }
  /// Ground speeds of tracks driven at these speeds; of a car, by its steering angle [rad].
  TrackCommand onGround(const TrackCommand& driven, double steering) const {
    if (!isCar()) return driven;
    const TrackCommand share = rearWheels(1.0, steering, wheelbase, gauge);
    return {driven.left * share.left, driven.right * share.right};
  }
  /// Lag of a car's steering, including the effect on it [s].
  double steeringLag() const { return std::max(0.0, steering_lag + effects.slow_steering); }
  /// Delay of commands, including the effect on it [s].
  double commandDelay() const { return std::max(0.0, delay + effects.command_delay); }
  /// Lag of the drive, including the effect on it [s].
  double driveLag() const { return std::max(0.0, lag + effects.actuator_lag); }
  /// The longest time constant with which a motion settles: drive and body in series.
  double settlingLag() const {
    return driveLag() + std::max(0.0, effects.lag_asymmetry) +
           std::max(effects.yaw_inertia, effects.body_inertia);
  }
};

/// One draw of the noise of an execution: factors N(1, spread), crab angle N(0, spread).
ExecutionNoise drawNoise(const ExecutionSpread& spread, std::mt19937_64& random);

/// Mean of a quantity over a step in which it follows its target, and its value at the end.
struct Followed {
  double mean;
  double end;
};

/// First-order lag [s] towards a constant target over dt; exact. Without lag it jumps to the
/// target.
Followed follow(double value, double target, double lag, double dt);

/// A target that changes over a step from one value to another with the given mean: a parabola.
struct MovingTarget {
  double from;
  double mean;
  double to;
};

/// First-order lag [s] behind a moving target over dt; exact.
Followed follow(double value, const MovingTarget& target, double lag, double dt);

/// First-order lag [s] behind a ramp of 1 / inverse_limit (0 = a step) to a target over dt; exact.
/** `ramp`: state of the ramp, updated. */
Followed followRamp(double value, double& ramp, double target, double inverse_limit, double lag,
                    double dt);

/// State of one track and its motor.
struct TrackState {
  double speed = 0.0;  ///< [m/s] of the drive, after its lag
  double ramp = 0.0;   ///< [m/s] asked of the drive, see slew_limit
  double taken = 0.0;  ///< [m] slack: 0 = taken up forwards, slack = taken up backwards
  double heat = 0.0;   ///< [1] low-pass of the duty, see thermal_derating
};

/// State of a car's steering.
struct Steering {
  double ramp = 0.0;     ///< [rad] demanded from the servo, see steering_rate
  double servo = 0.0;    ///< [rad] after its lag
  double linkage = 0.0;  ///< [rad] behind its play
};

/// Active share of each change, 0..1: averages over a short time step.
struct ChangesInForce {
  double payload = 0.0;
  double terrain_1 = 0.0;
  double terrain_2 = 0.0;
};

/// Forward speed and yaw rate of steady tracks, before the body's inertia.
struct PlaneMotion {
  double v = 0.0;
  double omega = 0.0;
};

// The effects, in the order in which they act.
namespace steps {

constexpr double kGravity = 9.81;         // [m/s2]
constexpr double kHour = 3600.0;          // [s]
constexpr double kLeastDivisor = 0.1;     // [1], keeps a negative loss from dividing by zero
constexpr double kSlopeFullSpeed = 0.05;  // [m/s], slower tracks slip less on a slope
constexpr double kTermFullSpeed = 0.05;   // [m/s], a vehicle at rest stays at rest

/// A value reduced by a dead zone: 0 up to `width`, the excess beyond, sign kept.
inline double deadZone(double value, double width) {
  const double rest = std::abs(value) - width;
  return rest <= 0.0 ? 0.0 : std::copysign(rest, value);
}

/// A value up to a limit (stored as its reciprocal; 0 = none), plus a share of the excess.
inline double limited(double value, double inverse_limit, double beyond) {
  if (std::abs(value) * inverse_limit <= 1.0) return value;
  const double limit = 1.0 / inverse_limit;
  return std::copysign(limit + beyond * (std::abs(value) - limit), value);
}

/// `value` / (1 + loss).
inline double lessened(double value, double loss) {
  return value / std::max(kLeastDivisor, 1.0 + loss);
}

/// Share of [from, from + dt] that is after `change`.
inline double shareAfter(double change, double from, double dt) {
  if (from >= change) return 1.0;
  return dt <= 0.0 ? 0.0 : std::clamp((from + dt - change) / dt, 0.0, 1.0);
}

/// Sum of both changes of ground.
inline double on(double first, double second, const ChangesInForce& changes) {
  return first * changes.terrain_1 + second * changes.terrain_2;
}

/// Changes in force on average from `session_time` over dt seconds (0 = at that instant).
inline ChangesInForce changesAt(const EffectValues& effects, double session_time, double dt) {
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

/// Speed asked of a track before derating by heat: deadband, saturation, battery.
/** `session_time` since the start of the session [s]; `drop` of the battery's voltage [1]. */
inline double suppliedSpeed(const EffectValues& effects, double asked, double session_time,
                            double drop) {
  double speed = asked;
  if (effects.motor_deadband != 0.0) speed = deadZone(speed, effects.motor_deadband);
  speed = limited(speed, effects.speed_saturation, 0.0);
  if (effects.battery_sag_per_hour != 0.0)
    speed *= std::max(0.0, 1.0 - effects.battery_sag_per_hour * session_time / kHour);
  if (effects.battery_sag_per_drop != 0.0)
    speed *= std::max(0.0, 1.0 - effects.battery_sag_per_drop * drop);
  return speed;
}

/// The drive's target for `supplied`, after derating and asymmetry; `side` is +1 for the left and
/// -1 for the right track.
inline double driveTarget(const EffectValues& effects, double supplied, double side, double heat) {
  double target = supplied;
  if (effects.thermal_derating != 0.0)
    target *= std::max(0.0, 1.0 - effects.thermal_derating * heat);
  if (effects.track_asymmetry != 0.0) target *= 1.0 + side * effects.track_asymmetry;
  const double loss = side > 0.0 ? effects.left_track_loss : effects.right_track_loss;
  if (loss != 0.0) target *= 1.0 - loss;
  return target;
}

/// Angle of a car's wheels [rad] for an angle of its linkage.
inline double wheelAngle(const VehicleModel& model, double linkage) {
  const EffectValues& effects = model.effects;
  return limited((model.steering_gain + effects.steering_ratio) * linkage + effects.steering_offset,
                 effects.steering_limit, 0.0);
}

/// Advances a car's steering by dt towards a command [rad]; returns the wheels' mean angle.
inline double steer(const VehicleModel& model, double command, double dt, Steering& steering) {
  const EffectValues& effects = model.effects;
  const Followed servo = followRamp(steering.servo, steering.ramp, command, effects.steering_rate,
                                    model.steeringLag(), dt);
  steering.servo = servo.end;
  if (effects.steering_play == 0.0) {
    steering.linkage = servo.end;
    return wheelAngle(model, servo.mean);
  }
  const double half = 0.5 * effects.steering_play;
  const double before = steering.linkage;
  const auto follows = [half](double behind, double angle) {
    return std::clamp(behind, angle - half, angle + half);
  };
  steering.linkage = follows(before, servo.end);
  return wheelAngle(model, follows(before, servo.mean));
}

/// Mean speed behind the slack; the drive's motion first takes up the slack.
inline double behindSlack(double slack, double mean, double dt, TrackState& track) {
  const double moved = mean * dt;
  const double taken = std::clamp(track.taken - moved, 0.0, slack);
  const double passed = moved + (taken - track.taken);
  track.taken = taken;
  return passed / dt;
}

/// Advances one track by dt towards `target`, which results from `supplied`; returns the track's
/// mean speed on the ground side of its slack.
inline double driveTrack(const VehicleModel& model, double supplied, double target, double dt,
                         TrackState& track) {
  const EffectValues& effects = model.effects;
  double lag = model.driveLag();
  if (effects.lag_asymmetry != 0.0 &&
      (std::abs(target) < std::abs(track.speed) || target * track.speed < 0.0))
    lag = std::max(0.0, lag + effects.lag_asymmetry);
  const Followed speed = followRamp(track.speed, track.ramp, target, effects.slew_limit, lag, dt);
  track.speed = speed.end;
  if (effects.thermal_derating != 0.0) {
    const double duty = supplied / model.full_speed;
    track.heat = follow(track.heat, duty * duty, effects.thermal_time, dt).end;
  }
  if (effects.track_backlash == 0.0) return speed.mean;
  return behindSlack(effects.track_backlash, speed.mean, dt, track);
}

/// Slip ratio, on the speed of either track.
inline TrackCommand slipped(const EffectValues& effects, const ChangesInForce& changes,
                            const TrackCommand& tracks) {
  const double slip =
      effects.slip_ratio + on(effects.terrain_slip_1, effects.terrain_slip_2, changes);
  if (slip == 0.0) return tracks;
  return {tracks.left * (1.0 - slip), tracks.right * (1.0 - slip)};
}

/// Resistance to turning and the limits of turning.
inline double turned(const EffectValues& effects, const ChangesInForce& changes, double v,
                     double omega) {
  const double width =
      effects.track_width + on(effects.terrain_width_1, effects.terrain_width_2, changes);
  if (width != 0.0) omega = lessened(omega, width);
  if (effects.yaw_rate_skid != 0.0)
    omega = lessened(omega, effects.yaw_rate_skid * std::abs(omega));
  const double breakaway =
      effects.yaw_breakaway + on(effects.terrain_breakaway_1, effects.terrain_breakaway_2, changes);
  if (breakaway > 0.0) omega = deadZone(omega, breakaway);
  omega = limited(omega, effects.turn_power_limit, effects.turn_power_beyond);
  if (effects.speed_understeer != 0.0) omega = lessened(omega, effects.speed_understeer * v * v);
  if (effects.reverse_yaw_gain != 0.0) omega *= 1.0 + effects.reverse_yaw_gain * v;
  if (changes.payload != 0.0) omega *= 1.0 + effects.payload_yaw * changes.payload;
  return limited(omega, effects.grip_limit * std::abs(v) / kGravity, effects.grip_beyond);
}

/// Losses of forward speed in a turn of `omega`.
inline double slowed(const EffectValues& effects, const ChangesInForce& changes, double v,
                     double omega) {
  if (effects.turn_speed_loss != 0.0) v = lessened(v, effects.turn_speed_loss * std::abs(omega));
  if (effects.reverse_speed_gain != 0.0) v += effects.reverse_speed_gain * std::abs(v);
  if (changes.payload != 0.0) v *= 1.0 + effects.payload_speed * changes.payload;
  if (effects.quadratic_drag != 0.0) v -= effects.quadratic_drag * v * std::abs(v);
  if (effects.rolling_resistance != 0.0) v = deadZone(v, effects.rolling_resistance);
  return v;
}

/// Slip, turning, limits and resistance: from track speeds to steady forward speed and yaw rate.
inline PlaneMotion groundMotion(const VehicleModel& model, const ExecutionNoise& noise,
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

/// The body twist of a forward speed and yaw rate: adds lateral motion and slopes.
/** `tan_crab` of the whole crab angle. `track_speeds` is used only to fade out slopes at
 * standstill. */
inline Twist2 bodyTwist(const EffectValues& effects, double tan_crab, const ChangesInForce& changes,
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

/// Share in 0..1 by which motion-dependent terms act: 0 at standstill, because a vehicle at rest
/// stays at rest.
inline double movingShare(const VehicleModel& model, const TrackCommand& track_speeds,
                          const TermInputs& inputs) {
  const double fastest = std::max({std::abs(track_speeds.left), std::abs(track_speeds.right),
                                   std::abs(inputs.v), 0.5 * model.gauge * std::abs(inputs.omega)});
  return std::min(1.0, fastest / kTermFullSpeed);
}

/// Change of the motion by unnamed terms, times the share.
inline Twist2 unnamedTwist(const VehicleModel& model, double share, const TermInputs& inputs) {
  const Twist2 all = twistOf(model.unnamed, inputs);
  return {share * all.v_x, share * all.v_y, share * all.omega};
}

}  // namespace steps
}  // namespace tread
