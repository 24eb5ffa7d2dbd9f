// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/soundness/core/log_validation.hpp"

// Whether commands explain the motion, and if not, which mistake of a recording does.
//   1. Speeds and turns that no ground vehicle makes are units: degrees for radians, mm for m.
//   2. The way driven against the heading, as it is and as it would be if it counted clockwise, in
//      degrees or in radians. Angles are doubled, since forwards and backwards are alike; what the
//      mean of exp(2i (course - heading)) says is how well the two belong together. A vehicle that
//      moves to all sides (omnidirectional) agrees with none of them, and nothing is concluded.
//   3. Speed and turn against sum and difference of the commands, and against each side alone: the
//      signs of the correlations name left and right swapped, a side that counts the other way,
//      body speeds in the columns of sides.
//   4. The gains, for commands that are speeds: km/h, mm, revolutions a minute.
// Only clear contradictions are problems; slip, lag and noise are not.
namespace tread::gap {

inline constexpr double kClear = 0.5;       // |correlation| from which a sign is certain
inline constexpr double kVeryClear = 0.8;   // with which it needs no second one
inline constexpr double kEarlier = 0.3;     // [s] by which no motion precedes its command
inline constexpr double kLongestLag = 2.0;  // [s] of a vehicle behind its commands
inline constexpr double kLever =
    0.8;  // [m] of the measured point from the centre of a turn, at most
inline constexpr double kGentle = 0.8;  // [rad] of a turn whose way is nearly its chord

struct MotionCheck {
  std::vector<std::string> lines;     ///< of speed and turn: gain, correlation and delay
  std::vector<std::string> problems;  ///< each in one line, named as what it is
};

MotionCheck checkMotion(const Drive& drive, const std::vector<PoseIncrement>& increments);

/// Whether one rate clearly goes against the other at every lag from `from` to `to` [s].
/** Commands that alternate agree and disagree equally well, at different lags. */
bool goesAgainst(const LagTable& table, double from, double to);

/// How far lags of commands can be looked for: a fifth of a typical segment, .5 to 10 s.
double lagReach(const Drive& drive);

}  // namespace tread::gap
