// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include "common/soundness/core/lag_table.hpp"

// Whether commands explain the motion, and if not, which recording mistake does.
//   1. Speeds and turns beyond any ground vehicle are wrong units: degrees for radians, mm for m.
//   2. Course against heading, as recorded and as if the heading were clockwise, in degrees or in
//      radians. Angles are doubled because forwards and backwards are alike; the mean of
//      exp(2i (course - heading)) measures the agreement. A vehicle that moves to all sides
//      (omnidirectional) agrees with none of them, and nothing is concluded.
//   3. Speed and turn against sum and difference of the commands, and against each side alone: the
//      signs of the correlations reveal left and right swapped, one side inverted, or body speeds
//      in the columns of sides.
//   4. The gains, for commands that are speeds: km/h, mm, revolutions a minute.
// Only clear contradictions are problems; slip, lag and noise are not.
namespace tread::gap {

inline constexpr double kClear = 0.5;      // |correlation| above which a sign is certain
inline constexpr double kVeryClear = 0.8;  // |correlation| that needs no second one as confirmation
inline constexpr double kEarlier = 0.3;    // [s] tolerance for motion before its command
inline constexpr double kLongestLag = 2.0;  // [s] longest delay of a vehicle after its commands
inline constexpr double kLever =
    0.8;  // [m] largest distance of the measured point from the centre of rotation
inline constexpr double kGentle = 0.8;  // [rad] of a turn whose arc is nearly its chord

/// `notes`: without anything fatal so far.
void checkMotion(const Drive& drive, const std::vector<PoseIncrement>& increments,
                 Diagnostics& notes);

/// Whether one rate clearly opposes the other at every lag from `from` to `to` [s].
/** Alternating commands agree and disagree equally well, at different lags. */
bool goesAgainst(const LagTable& table, double from, double to);

/// Longest lag of commands worth searching: a fifth of a typical segment, .5 to 10 s.
double lagReach(const Drive& drive);

}  // namespace tread::gap
