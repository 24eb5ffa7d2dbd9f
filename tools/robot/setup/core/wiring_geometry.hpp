// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <optional>
#include <vector>

#include "tools/robot/setup/core/wiring_fit.hpp"

namespace tread::setup {

/// The quantities that a fit leads to, in the order of WiringReport.
/** Speeds of the real sides at full command [m/s], effective gauge [m], yaw of the INS [rad], its
 * place [m], delay, lag [s], dead power [1]. */
enum Quantity { kLeft, kRight, kWidth, kYaw, kX, kY, kDelay, kLag, kDeadPower, kQuantities };
using Quantities = std::array<double, kQuantities>;

/// How the configured left and right side are connected, if they are swapped or not.
struct WiringGeometry {
  bool swapped = false;
  bool reverse_left = false;  ///< the configured left side
  bool reverse_right = false;
  Quantities of{};
};

/// What a response says if left and right are swapped or not: both are the same motions with front
/// and rear exchanged.
WiringGeometry geometryOf(const WiringFit& fit, bool swapped);

/// The same where only one of the configured sides moves (0 = left). How wide it is, it does not
/// tell; ahead is where the INS looks.
WiringGeometry geometryOfOne(const WiringFit& fit, int alive);

/// Full speed of the real sides [m/s], straight ahead and back.
struct StraightSpeed {
  double left = 0.0;
  double right = 0.0;
};

/// One for each time that both real sides were given the same full command for long enough.
/** Turning drags on both sides, so that a response over all motions tells less than this. */
std::vector<StraightSpeed> straightSpeeds(const std::vector<GivenCommand>& commands,
                                          const std::vector<InsFix>& fixes,
                                          const WiringGeometry& geometry);

}  // namespace tread::setup
