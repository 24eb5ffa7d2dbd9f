// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/grid/grid.hpp"
#include "modules/planner/core/search/pattern_table.hpp"

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

/// A primitive of a file as the planner searches with it; its id is its place in the list.
struct SearchPrimitive : planner::Primitive {
  int file_id = 0;               ///< as the file numbers it
  int start_bin = 0;             ///< heading bin in which it may begin
  std::vector<CellIndex> cells;  ///< of a lattice: that it passes, relative to that of its start
};

/// The primitives of start bin 0, for any heading; they cost their duration times their multiplier.
/** The duration is the slower of driving their length and turning their turn. Throws ConfigError
 * with one line if none begins there. */
std::vector<SearchPrimitive> headingFree(const PrimitiveFile& file, const PrimitivePace& pace);

/// All primitives by start bin, in the order of the file; exactly on the lattice, at SBPL's cost.
/** The cost is whole ms of the slower of driving and turning, rounded up, times the multiplier; it
 * is multiplied by the map's cost later. Source: SBPL's environment_navxythetalat (BSD), whose
 * rounding is repeated: length is the sum over the poses, the turn that between the bins' headings.
 */
std::vector<SearchPrimitive> onLattice(const PrimitiveFile& file, const PrimitivePace& pace);

}  // namespace tread::plan
