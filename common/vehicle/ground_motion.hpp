// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/vehicle/model.hpp"

namespace tread {

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
