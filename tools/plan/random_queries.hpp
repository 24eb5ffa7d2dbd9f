// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <functional>
#include <vector>

#include "common/grid/grid.hpp"
#include "tools/plan/query_file.hpp"

namespace tread::plan {

/// What random queries are wanted.
struct RandomQueries {
  size_t count = 100;
  uint64_t seed = 1;
  double apart = 3.0;  ///< [m] farther than this the goal is from the start
};

/// Draws starts and goals evenly over a grid's window and all headings, and keeps those that are
/// free and far enough apart; the same seed gives the same on every machine.
/** `is_free` says it of T_grid_body; T_map_grid stands the result in the map's frame. Throws
 * std::runtime_error with one line if a thousand times as many draws are not enough. */
std::vector<PlanQuery> randomQueries(const Grid& grid, const Pose2& T_map_grid,
                                     const RandomQueries& wanted,
                                     const std::function<bool(const Pose2&)>& is_free);

}  // namespace tread::plan
