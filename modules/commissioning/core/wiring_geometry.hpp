// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <vector>

#include "modules/commissioning/core/wiring_fit.hpp"

namespace tread::commissioning {

/// Quantities derived from a fit, in the order of WiringReport.
/** Speeds of the real sides at full command [m/s], effective gauge [m], yaw of the INS [rad], its
 * position [m], delay, lag [s], dead power [1]; of a car also wheel angles at full steering to the
 * left, to the right, and at zero command [rad], and the lag of the steering [s]. */
enum Quantity {
  kLeft,
  kRight,
  kWidth,
  kYaw,
  kX,
  kY,
  kDelay,
  kLag,
  kDeadPower,
  kSteeringLeft,
  kSteeringRight,
  kSteeringStraight,
  kSteeringLag,
  kQuantities
};
using Quantities = std::array<double, kQuantities>;

constexpr bool isAngle(size_t quantity) {
  return quantity == kYaw || (quantity >= kSteeringLeft && quantity <= kSteeringStraight);
}

/// Connection of the configured left and right side, or of throttle and steering.
struct WiringGeometry {
  bool swapped = false;
  bool reverse_left = false;  ///< the configured left side, or the throttle
  bool reverse_right = false;
  Quantities of{};
};

/// Interpretation of a response for swapped or unswapped sides: both explain the same motions, with
/// front and rear exchanged.
WiringGeometry geometryOf(const WiringFit& fit, bool swapped);

/// The same if only one configured side moves (0 = left). The width is then unknown; ahead is the
/// INS's direction.
WiringGeometry geometryOfOne(const WiringFit& fit, int alive);

/// The same of a car, for a throttle that drives forwards or backwards.
WiringGeometry geometryOfCar(const WiringFit& fit, bool backwards, double wheelbase);

/// Full speed of the real sides [m/s], straight ahead and back.
struct StraightSpeed {
  double left = 0.0;
  double right = 0.0;
};

/// One entry per period in which both real sides had the same full command for long enough.
/** Turning drags on both sides, so a fit over all motions is less accurate. */
std::vector<StraightSpeed> straightSpeeds(const std::vector<TimedCommand>& commands,
                                          const std::vector<TimedPose>& fixes,
                                          const WiringGeometry& geometry);

}  // namespace tread::commissioning
