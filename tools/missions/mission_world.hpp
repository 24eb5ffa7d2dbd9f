// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>

#include "common/geometry/footprint_size.hpp"
#include "modules/simulator/core/world.hpp"

namespace tread::missions {

/// What a mission takes place in: hard on purpose, the same for the same seed.
/** From start to goal at least `shortest`, at most 1.68 times that; walls whose only near gap lies
 * off the straight line, pockets that open towards the start, scattered boulders; no gap between
 * obstacles is narrower than the footprint plus 0.4 m; one to three changes of surface on the way;
 * gentle slopes. A way of the footprint's width exists. */
struct MissionWorld {
  uint64_t seed = 0;
  Pose2 T_map_start;
  Pose2 T_map_goal;
  double straight_line = 0.0;  ///< [m]
  bool line_blocked = false;   ///< the footprint cannot drive the straight line
  int surface_changes = 0;     ///< borders between surfaces that the straight line crosses: 1 to 3
  sim::WorldDescription description;
};

/// Shortest straight line from start to goal [m].
inline constexpr double kShortestLine = 25.0;

/** `shortest` [m]: with longer lines each surface is driven for longer. */
MissionWorld makeMissionWorld(uint64_t seed, const FootprintSize& robot,
                              double shortest = kShortestLine);

/// Narrowest gap between obstacles that a mission may hold [m].
constexpr double narrowestGap(const FootprintSize& robot) {
  return 2.0 * robot.half_width + 0.4;
}

}  // namespace tread::missions
