// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>

#include <tread/execution_t.hpp>
#include <tread/goal_t.hpp>
#include <tread/map_tile_t.hpp>
#include <tread/motor_t.hpp>
#include <tread/plan_t.hpp>
#include <tread/plan_tree_t.hpp>
#include <tread/program_slot_t.hpp>

#include "modules/planner/core/execution/program_book.hpp"
#include "modules/planner/core/execution/situation.hpp"

namespace tread::planner {

/// Between the planner's core and its messages. What makes no sense becomes nothing.
std::optional<Goal> goalFrom(const goal_t& message);
std::optional<Tile> tileFrom(const map_tile_t& message);
BridgeReading readingFrom(const motor_t& message);
std::vector<ExecutionReading> readingsFrom(const execution_t& message);

program_slot_t toMessage(const Slot& slot);
/// Without seq and search_time.
plan_t toMessage(const PlanReport& report);
/// Without utime and seq.
plan_tree_t toMessage(const std::vector<TreeNode>& tree, const std::vector<int>& branch);

}  // namespace tread::planner
