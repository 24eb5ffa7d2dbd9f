// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "common/geometry/se2.hpp"
#include "common/grid/grid.hpp"

namespace tread::plan {

/// Start and goal of a plan, in the map's frame.
struct PlanQuery {
  Pose2 T_map_start;
  Pose2 T_map_goal;
};

/// Reads lines "x y yaw x y yaw" [m, rad]: start and goal; # begins a comment.
/** Throws ConfigError with one line "file:line: error", also for an empty file. */
std::vector<PlanQuery> readQueries(const std::string& path);

/// The same from text; `name` replaces the file in messages.
std::vector<PlanQuery> parseQueries(std::string text, const std::string& name);

/// Text of such a file; parseQueries() of it returns bitwise the same numbers.
std::string formatQueries(const std::vector<PlanQuery>& queries);

/// Parameters of random queries.
struct RandomQueries {
  size_t count = 100;
  uint64_t seed = 1;
  double apart = 3.0;  ///< [m] least distance from start to goal
};

/// Draws starts and goals uniformly over a grid's window and all headings, and keeps pairs that are
/// free and far enough apart; a seed gives the same result on every platform.
/** `is_free` tests T_grid_body; T_map_grid converts the result to the map's frame. Throws
 * std::runtime_error with one line after a thousand times as many failed draws. */
std::vector<PlanQuery> randomQueries(const Grid& grid, const Pose2& T_map_grid,
                                     const RandomQueries& wanted,
                                     const std::function<bool(const Pose2&)>& is_free);

}  // namespace tread::plan
