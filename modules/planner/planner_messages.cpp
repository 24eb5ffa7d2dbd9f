// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/planner/planner_messages.hpp"

#include <cmath>
#include <limits>

#include "common/messages/blank.hpp"

namespace tread::planner {
namespace {

constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
constexpr double kFarthest = 1e6;  // [m] a goal can be from the origin of map
constexpr int kMaxTileCells = 512;

}  // namespace

std::optional<Goal> goalFrom(const goal_t& message) {
  const double* pose = message.goal_pose;
  const bool finite =
      std::abs(pose[0]) < kFarthest && std::abs(pose[1]) < kFarthest && std::isfinite(pose[2]);
  const bool tolerant = message.position_tolerance > 0.0 && message.yaw_tolerance > 0.0 &&
                        message.position_tolerance < kFarthest;
  if (!finite || !tolerant || message.goal_id == 0) return std::nullopt;
  return Goal{message.goal_id,
              {pose[0], pose[1], pose[2]},
              message.position_tolerance,
              message.yaw_tolerance};
}

std::optional<Tile> tileFrom(const map_tile_t& message) {
  const int side = message.tile_cells;
  if (side < 1 || side > kMaxTileCells || message.num_cells != side * side) return std::nullopt;
  if (!(message.cell_size > 0.001 && message.cell_size < 10.0)) return std::nullopt;
  if (std::abs(static_cast<int64_t>(message.tile_x)) * side > 1'000'000 ||
      std::abs(static_cast<int64_t>(message.tile_y)) * side > 1'000'000)
    return std::nullopt;
  return Tile{message.tile_x, message.tile_y, message.utime, message.cells};
}

plan_t toMessage(const PlanReport& report) {
  auto message = blank<plan_t>();
  message.utime = report.utime;
  message.goal_id = report.goal_id;
  message.set_version = report.set_version;
  message.plan_status = static_cast<int16_t>(report.status);
  message.reason = report.reason;
  message.time_to_go = report.time_to_go;
  message.expansions = report.expansions;
  message.num_patterns = static_cast<int32_t>(report.steps.size());
  message.execution_id = report.execution_ids;
  for (const PlanStep& step : report.steps) {
    message.pattern_id.push_back(step.pattern_id);
    message.pose.push_back({step.T_map_end.x, step.T_map_end.y, step.T_map_end.yaw});
    const Uncertainty& u = step.uncertainty;
    message.covariance.push_back({u.xx, u.xy, u.xyaw, u.yy, u.yyaw, u.yawyaw});
  }
  return message;
}

plan_tree_t toMessage(const std::vector<TreeNode>& tree, const std::vector<int>& branch) {
  auto message = blank<plan_tree_t>();
  message.num_nodes = static_cast<int32_t>(tree.size());
  for (const TreeNode& node : tree) {
    message.parent.push_back(node.parent);
    message.by_pattern.push_back(node.pattern_id);
    message.node_pose.push_back({static_cast<float>(node.T_map_body.x),
                                 static_cast<float>(node.T_map_body.y),
                                 static_cast<float>(node.T_map_body.yaw)});
    message.time_at.push_back(static_cast<float>(node.time));
  }
  message.num_best = static_cast<int32_t>(branch.size());
  message.best.assign(branch.begin(), branch.end());
  return message;
}

}  // namespace tread::planner
