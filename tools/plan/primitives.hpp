// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "common/grid/grid.hpp"

namespace tread::plan {

/// One motion primitive of a lattice planner.
struct Primitive {
  int id = 0;         ///< unique among those of a start bin only
  int start_bin = 0;  ///< heading bin in which it begins
  int dx = 0;         ///< [cells] to where it ends
  int dy = 0;
  int end_bin = 0;
  int cost_multiplier = 1;
  std::vector<Pose2> poses;  ///< from the start cell's centre in the map's axes: turned already
};

/// A set of motion primitives as its file has it.
struct PrimitiveFile {
  std::string name;              ///< the file that it was read from
  double resolution = 0.025;     ///< [m] side of a cell
  std::vector<double> headings;  ///< [rad] 0..2 pi, by bin, rising
  std::vector<Primitive> primitives;
};

/// Reads SBPL's motion primitives (.mprim), with or without stated angles.
/** A primitive is at least two poses, the first in the start's cell and bin, the last in the end's,
 * and moves or turns. Throws ConfigError with one line "file:line: primitive N: what is wrong". */
PrimitiveFile readPrimitives(const std::string& path);

/// The same from text; `name` stands for the file in messages.
PrimitiveFile parsePrimitives(std::string text, const std::string& name);

/// The bin whose heading is nearest to an angle [rad].
int nearestBin(const std::vector<double>& headings, double yaw);

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
