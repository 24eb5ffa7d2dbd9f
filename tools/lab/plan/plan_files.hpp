// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <vector>

#include "common/geometry/se2.hpp"
#include "common/grid/grid.hpp"
#include "modules/planner/core/search/pattern_table.hpp"

namespace tread::plan {

/// Limits of a map: side length [cells], number of cells.
inline constexpr int kLongestSide = 60'000;
inline constexpr int64_t kMostCells = 64'000'000;

/// One motion primitive of a lattice planner.
struct LatticePrimitive {
  int id = 0;         ///< unique only within a start bin
  int start_bin = 0;  ///< heading bin at its start
  int dx = 0;         ///< [cells] displacement of its end
  int dy = 0;
  int end_bin = 0;
  int cost_multiplier = 1;
  std::vector<Pose2> poses;  ///< from the start cell's centre, in the map's axes (already rotated)
};

/// Contents of a file of motion primitives.
struct PrimitiveFile {
  std::string name;              ///< its file
  double resolution = 0.025;     ///< [m] side of a cell
  std::vector<double> headings;  ///< [rad] 0..2 pi, by bin, rising
  std::vector<LatticePrimitive> primitives;
};

}  // namespace tread::plan
