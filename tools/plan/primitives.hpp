// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <vector>

#include "common/grid/grid.hpp"
#include "tools/plan/primitive_file.hpp"

namespace tread::plan {

/// How fast the robot is that drives primitives, which say nothing of it themselves.
struct PrimitivePace {
  double speed = 1.0;      ///< [m/s]
  double turn_time = 2.0;  ///< [s] to turn by 45 degrees
};

/// A primitive for any heading.
struct FreePrimitive {
  int id = 0;
  std::vector<Pose2> trajectory;  ///< T_start_body, without the start itself; yaw unwrapped
  double duration = 0.0;          ///< [s] the slower of driving its length and turning its turn
  double cost_factor = 1.0;       ///< [1] of the duration
};

/// The primitives of start bin 0, in the frame of their start.
/** Throws ConfigError with one line if none begins there. */
std::vector<FreePrimitive> headingFree(const PrimitiveFile& file, const PrimitivePace& pace);

/// A primitive on the lattice, with the cost that SBPL gives it.
struct LatticeAction {
  int id = 0;
  int dx = 0;  ///< [cells]
  int dy = 0;
  int end_bin = 0;
  int64_t cost = 0;       ///< whole ms of the slower of driving and turning, rounded up, times the
                          ///< multiplier; before the map's cost counts
  double duration = 0.0;  ///< [s] of the slower of the two
  std::vector<CellIndex> cells;  ///< that its poses pass one after the other, from the start's cell
};

/// All primitives by start bin, in the order of the file.
/** Source: SBPL's environment_navxythetalat (BSD), whose rounding is repeated: length is the sum
 * over the poses, the turn that between the bins' headings. */
std::vector<std::vector<LatticeAction>> latticeActions(const PrimitiveFile& file,
                                                       const PrimitivePace& pace);

}  // namespace tread::plan
