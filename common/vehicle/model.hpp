// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <random>
#include <string>
#include <vector>

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

/// A vehicle on one ground: nominal two-track model and the effects that are on.
/** v_x = forward_gain (vl + vr) / 2, omega = yaw_gain (vr - vl) / gauge, v_y = 0; track speeds
 * follow the commands after a delay with a first-order lag. Effects change these three afterwards,
 * in the order of the catalogue. */
struct VehicleModel {
  VehicleModel();

  std::string name;
  CommandKind kind = CommandKind::kPower;
  double full_speed = 1.0;    ///< [m/s] track speed at power 1; not used for track speed commands
  double lag = 0.0;           ///< [s] time constant of the track speeds
  double delay = 0.0;         ///< [s] before a command begins to act
  double gauge = 1.0;         ///< [m] between the middles of the tracks
  double forward_gain = 1.0;  ///< [1] ground speed over mean track speed
  double yaw_gain = 1.0;      ///< [1] yaw rate over that of the track speeds
  /// Values of each effect's parameters, in the order of the catalogue; 0 = off.
  std::vector<std::vector<double>> effects;
  ExecutionSpread spread;

  /// A parameter of an effect by name; throws std::out_of_range if there is none.
  double& effect(const std::string& effect_name, const std::string& parameter);
  double effect(const std::string& effect_name, const std::string& parameter) const;

  /// Track speeds that a command asks for, left and right [m/s].
  TrackCommand trackSpeeds(const TrackCommand& command) const;
  /// Body motion at these track speeds with this noise.
  VehicleMotion motionAt(const TrackCommand& track_speeds, const ExecutionNoise& noise) const;
};

/// One draw of the noise of an execution: factors N(1, spread), crab angle N(0, spread).
ExecutionNoise drawNoise(const ExecutionSpread& spread, std::mt19937_64& random);

}  // namespace tread
