// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/fence/fence.hpp"
#include "tools/lab/missions/mission.hpp"

namespace tread::limits {

/// Kind of limits under test.
enum class Kind { kFences, kSlopes };

/// A mission and its limits, a function of the seed.
/** Obstacles and surfaces are those of a mission of 14 to 24 m. Fences: a yard with a notch around
 * the way, up to two polygons to keep out of on it, often another one that an operator's message
 * puts before the driving robot; sometimes the planner does not know them, and sometimes the robot
 * starts outside. Slopes: one to four hills or pits on the way, at their steepest 8 to 40 degrees.
 */
struct LimitWorld {
  missions::MissionWorld mission;
  std::vector<Fence> fences;         ///< of the robot's file
  std::optional<double> surprise_s;  ///< [s] after the start at which a fence comes up ahead
  double surprise_ahead = 3.0;       ///< [m] from the body's origin to its near side
  double surprise_width = 2.0;       ///< [m]
  bool planner_knows = true;         ///< else only the bridge does
  bool starts_outside = false;
};

LimitWorld limitWorld(uint64_t seed, Kind kind, const FootprintSize& outline);

}  // namespace tread::limits
