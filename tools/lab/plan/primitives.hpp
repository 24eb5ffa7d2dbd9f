// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "tools/lab/plan/plan_files.hpp"

namespace tread::plan {

/// Reads SBPL's motion primitives (.mprim), with or without stated angles.
/** A primitive has at least two poses, the first in the start's cell and bin, the last in the
 * end's, and moves or turns. Throws ConfigError with one line "file:line: primitive N: error". */
PrimitiveFile readPrimitives(const std::string& path);

/// The same from text; `name` replaces the file in messages.
PrimitiveFile parsePrimitives(std::string text, const std::string& name);

/// Inconsistency of a primitive's start or end; empty if none.
std::string endsProblem(const LatticePrimitive& primitive, const PrimitiveFile& file);

/// The bin with the heading nearest to an angle [rad].
int nearestBin(const std::vector<double>& headings, double yaw);

/// Speed of the robot that drives primitives, which contain no speed themselves.
struct PrimitivePace {
  double speed = 1.0;      ///< [m/s]
  double turn_time = 2.0;  ///< [s] to turn by 45 degrees
};

/// A primitive for the planner's search; its id is its index.
struct SearchPrimitive : planner::Primitive {
  int file_id = 0;    ///< number in the file
  int start_bin = 0;  ///< heading bin in which it may start
  /// for a lattice: the cells that it passes, relative to the start's
  std::vector<CellIndex> cells;
};

/// The primitives of start bin 0, for any heading; the cost is their duration times their
/// multiplier.
/** The duration is the longer of driving their length and turning their angle. Throws ConfigError
 * with one line if none starts there. */
std::vector<SearchPrimitive> headingFree(const PrimitiveFile& file, const PrimitivePace& pace);

/// All primitives by start bin, in the order of the file, exactly on the lattice with SBPL's cost.
/** The cost is whole ms of the slower of driving and turning, rounded up, times the multiplier; it
 * is multiplied by the map's cost later. Source: SBPL's environment_navxythetalat (BSD), whose
 * rounding is repeated: length is the sum over the poses, the turn that between the bins' headings.
 */
std::vector<SearchPrimitive> onLattice(const PrimitiveFile& file, const PrimitivePace& pace);

}  // namespace tread::plan
