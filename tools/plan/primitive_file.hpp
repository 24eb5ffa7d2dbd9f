// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/geometry/se2.hpp"

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

}  // namespace tread::plan
