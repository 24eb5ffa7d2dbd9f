// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "tools/robot/setup/core/wiring_check.hpp"

namespace tread::setup {

/// checkWiring() for a car with throttle and steering commands.
/** 1. The rear axle moves in one direction, which is ahead or astern; any other point also moves by
 *    turning. So the INS's mounting and position are found (CarFit).
 * 2. The direction and strength of the turn at a steering command, with the wheelbase, give the
 *    wheel angle.
 * 3. A reversed throttle reverses motion and turning, reversed steering only the turning, an INS
 *    turned by 180 deg only the motion. Of two explanations the one with fewer faulty parts holds,
 *    unless `expected.seen` decides. */
WiringReport checkCar(const std::vector<TimedCommand>& commands,
                      const std::vector<TimedPose>& fixes, const WiringExpectation& expected);

}  // namespace tread::setup
