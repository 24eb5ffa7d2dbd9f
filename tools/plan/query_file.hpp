// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <vector>

#include "common/grid/grid.hpp"

namespace tread::plan {

/// From where to where a plan is wanted, in the map's own frame.
struct PlanQuery {
  Pose2 T_map_start;
  Pose2 T_map_goal;
};

/// Reads "x y yaw x y yaw" [m, rad] a line: start and goal; from # on a line is comment.
/** Throws ConfigError with one line "file:line: what is wrong", also for a file without any. */
std::vector<PlanQuery> readQueries(const std::string& path);

/// The same from text; `name` stands for the file in messages.
std::vector<PlanQuery> parseQueries(std::string text, const std::string& name);

/// Text of such a file; parseQueries() of it gives the same numbers, bit for bit.
std::string formatQueries(const std::vector<PlanQuery>& queries);

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
