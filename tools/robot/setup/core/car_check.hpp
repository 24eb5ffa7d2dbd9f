// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "tools/robot/setup/core/wiring_check.hpp"

namespace tread::setup {

/// checkWiring() for a car, whose commands are throttle and steering.
/** 1. The rear axle moves along one direction, which is ahead or astern, and a point beside it by
 *     turning, too: so the INS's mounting and place are found (CarFit).
 *  2. Which way it turns at a steering, and how much for its wheelbase, is the angle of its wheels.
 *  3. A reversed throttle turns the way and, with it, the turning; reversed steering the turning
 *     alone; an INS turned by half a turn the way alone. Of two explanations the one with fewer
 *     parts holds, unless `expected.seen` says. */
WiringReport checkCar(const std::vector<GivenCommand>& commands, const std::vector<InsFix>& fixes,
                      const WiringExpectation& expected);

}  // namespace tread::setup
