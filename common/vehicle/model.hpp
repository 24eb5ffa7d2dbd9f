// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <random>
#include <string>

#include "common/geometry/se2.hpp"
#include "common/pattern/pattern.hpp"
#include "common/vehicle/effects.hpp"

namespace tread {

/// How much one execution differs from the next on the same ground: standard deviations.
struct ExecutionSpread {
  double forward = 0.0;  ///< [1] of the factor on the forward speed
  double yaw = 0.0;      ///< [1] of the factor on the yaw rate
  double crab = 0.0;     ///< [rad] of the direction of travel
};

/// What chance made of one execution; the default is the mean.
struct ExecutionNoise {
  double forward = 1.0;  ///< [1] factor on the forward speed
  double yaw = 1.0;      ///< [1] factor on the yaw rate
  double crab = 0.0;     ///< [rad] added to the direction of travel
};

/// What is known of a moment of a drive beside the command; level, at the start, by default.
/** Frames: x forward, y left, z up; a nose that points down is a positive pitch, a raised left side
 * a positive roll. */
struct DriveContext {
  double session_time = 0.0;  ///< [s] since the start of the session
  double battery_drop = 0.0;  ///< [1] relative fall of the voltage since then; 0 = not measured
  double roll = 0.0;          ///< [rad]
  double pitch = 0.0;         ///< [rad]
};

/// A vehicle on one ground: nominal two-track model and the effects that are on.
/** v_x = forward_gain (vl + vr) / 2, omega = yaw_gain (vr - vl) / gauge, v_y = 0; track speeds
 * follow the commands after a delay with a first-order lag. In which order effects act on that:
 * kernel.hpp. */
struct VehicleModel {
  std::string name;
  CommandKind kind = CommandKind::kPower;
  double full_speed = 1.0;    ///< [m/s] track speed at power 1; not used for track speed commands
  double lag = 0.0;           ///< [s] time constant of the track speeds
  double delay = 0.0;         ///< [s] before a command begins to act
  double gauge = 1.0;         ///< [m] between the middles of the tracks
  double forward_gain = 1.0;  ///< [1] ground speed over mean track speed
  double yaw_gain = 1.0;      ///< [1] yaw rate over that of the track speeds
  double step = 0.005;        ///< [s] longest step of integration
  EffectValues effects;
  ExecutionSpread spread;

  /// A parameter of a vehicle effect by name; throws std::out_of_range if there is none.
  double& effect(const std::string& effect_name, const std::string& parameter);
  double effect(const std::string& effect_name, const std::string& parameter) const;

  /// Track speeds that a command asks for, left and right [m/s].
  TrackCommand trackSpeeds(const TrackCommand& command) const {
    if (kind == CommandKind::kTrackSpeed) return command;
    return {full_speed * command.left, full_speed * command.right};
  }
  /// Delay of commands with the effect on it [s].
  double commandDelay() const { return std::max(0.0, delay + effects.command_delay); }
  /// Lag of the drive with the effect on it [s].
  double driveLag() const { return std::max(0.0, lag + effects.actuator_lag); }
  /// The longest time constant with which a motion settles: drive and body, one after the other.
  double settlingLag() const {
    return driveLag() + std::max(0.0, effects.lag_asymmetry) +
           std::max(effects.yaw_inertia, effects.body_inertia);
  }
};

/// One draw of the noise of an execution: factors N(1, spread), crab angle N(0, spread).
ExecutionNoise drawNoise(const ExecutionSpread& spread, std::mt19937_64& random);

}  // namespace tread
