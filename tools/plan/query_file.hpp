// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/geometry/se2.hpp"

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

}  // namespace tread::plan
