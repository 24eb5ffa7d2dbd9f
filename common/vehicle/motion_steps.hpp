// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/vehicle/model.hpp"

namespace tread {

/// A quantity that follows its target for a while: its mean meanwhile and its value at the end.
struct Followed {
  double mean;
  double end;
};

/// First-order lag [s] towards a constant target over dt; exact. Without lag it is there at once.
Followed follow(double value, double target, double lag, double dt);

/// The same with a rate of at most 1 / inverse_limit (0 = no limit): a ramp, then the lag; exact.
Followed follow(double value, double target, double lag, double inverse_limit, double dt);

/// A target that runs from one value to another over a step, with that mean: a parabola.
struct MovingTarget {
  double from;
  double mean;
  double to;
};

/// First-order lag [s] behind a moving target over dt; exact.
Followed follow(double value, const MovingTarget& target, double lag, double dt);

/// What one track and its motor remember.
struct TrackState {
  double speed = 0.0;  ///< [m/s] of the drive, after its lag
  double taken = 0.0;  ///< [m] slack: 0 = taken up forwards, slack = taken up backwards
  double heat = 0.0;   ///< [1] low-pass of the duty, see thermal_derating
};

/// Speed that a track is asked for before it loses power to heat: deadband, saturation, battery.
/** `session_time` since the start of the session [s]; `drop` of the battery's voltage [1]. */
double suppliedSpeed(const EffectValues& effects, double asked, double session_time, double drop);

/// Moves one track on by dt towards `supplied`; `side` is +1 for the left and -1 for the right one.
/** Returns the mean speed of the track on the ground side of its slack. */
double driveTrack(const VehicleModel& model, double supplied, double side, double dt,
                  TrackState& track);

/// Target that `supplied` is for the drive, after derating and asymmetry.
double driveTarget(const EffectValues& effects, double supplied, double side, double heat);

/// How much of a change is in force, 0..1 each: averages over a short step of time.
struct ChangesInForce {
  double payload = 0.0;
  double terrain_1 = 0.0;
  double terrain_2 = 0.0;
};

/// What has changed from `session_time` on for dt seconds (0 = at that moment).
ChangesInForce changesAt(const EffectValues& effects, double session_time, double dt);

/// Forward speed and yaw rate to which steady tracks lead, before the body's inertia.
struct PlaneMotion {
  double v = 0.0;
  double omega = 0.0;
};

/// Slip, turning, limits and resistance: from track speeds to steady forward speed and yaw rate.
PlaneMotion groundMotion(const VehicleModel& model, const ExecutionNoise& noise,
                         const ChangesInForce& changes, const TrackCommand& track_speeds);

/// The body twist that forward speed and yaw rate go with: motion to the side and slopes.
/** `tan_crab` of the whole crab angle. `track_speeds` only to fade slopes out at standstill. */
Twist2 bodyTwist(const EffectValues& effects, double tan_crab, const ChangesInForce& changes,
                 const DriveContext& context, const TrackCommand& track_speeds,
                 const PlaneMotion& motion);

}  // namespace tread
