// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <vector>

#include "modules/identification/core/finding.hpp"

namespace tread::gap {

/// The scales with which encoders and gyro explain the poses of a drive best.
struct Reckoning {
  double speed = 1.0;        ///< ground speed over the mean of the encoders' track speeds
  double speed_lag = 0.0;    ///< [s] of the poses behind the encoders
  double turning = 1.0;      ///< of the heading over the gyro
  double turning_lag = 0.0;  ///< [s] of the heading behind the gyro
  double drift = 0.0;        ///< [rad/s] of the heading where the gyro says 0
  double sideways = 0.0;     ///< [s] motion to the left for each v omega
};

/// Fitted over a drive (least absolute deviations); nothing without encoders, gyro or motion.
std::optional<Reckoning> fitReckoning(const Drive& drive);

/// The floor: how far dead reckoning with encoders and gyro ends from the measured poses.
/** Forward speed from the mean of the encoders, yaw rate from the gyro, motion to the side with
 * their product (without it a wide turn at speed ends further off than a good model of the
 * commands); scales and lags fitted to each drive; over the same fixes and scaled to the same
 * horizon as endErrors(). It has seen the motion, so that a model which knows only the commands is
 * not expected to be better (but on ice, where tracks slip). Nothing where no execution has
 * encoders, gyro and poses. */
std::optional<EndErrors> deadReckoningFloor(const std::vector<Drive>& drives);

}  // namespace tread::gap
