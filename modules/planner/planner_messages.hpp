// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>

#include <tread/goal_t.hpp>
#include <tread/map_tile_t.hpp>
#include <tread/plan_t.hpp>
#include <tread/plan_tree_t.hpp>

#include "modules/planner/core/execution/planner_inputs.hpp"

namespace tread::planner {

/// Conversions between the planner's core and its messages; nothing for an invalid message.
std::optional<Goal> goalFrom(const goal_t& message);
std::optional<Tile> tileFrom(const map_tile_t& message);
/// Without seq and search_time.
plan_t toMessage(const PlanReport& report);
/// Without utime and seq.
plan_tree_t toMessage(const std::vector<TreeNode>& tree, const std::vector<int>& branch);

}  // namespace tread::planner
