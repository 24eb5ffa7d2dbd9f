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

BridgeReading::State stateFrom(int16_t state) {
  switch (state) {
    case motor_t::STATE_ARMED:
      return BridgeReading::State::kArmed;
    case motor_t::STATE_DRIVING:
      return BridgeReading::State::kDriving;
    case motor_t::STATE_STOPPING:
      return BridgeReading::State::kStopping;
    case motor_t::STATE_FAULT:
      return BridgeReading::State::kFault;
    case motor_t::STATE_ESTOP:
      return BridgeReading::State::kEstopped;
    default:
      return BridgeReading::State::kDisarmed;
  }
}

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

BridgeReading readingFrom(const motor_t& message) {
  BridgeReading reading;
  reading.utime = message.utime;
  reading.state = stateFrom(message.bridge_state);
  reading.reason = message.state_reason;
  reading.run_id = message.motor_run_id;
  reading.execution_id = message.execution_id;
  reading.command_index = message.command_index;
  return reading;
}

std::vector<ExecutionReading> readingsFrom(const execution_t& message) {
  std::vector<ExecutionReading> readings;
  for (const execution_record_t& record : message.records) {
    ExecutionReading reading;
    reading.run_id = record.record_run_id;
    reading.execution_id = record.record_execution_id;
    reading.started = record.started;
    reading.ended = record.ended;
    if (record.outcome == execution_record_t::OUTCOME_COMPLETED)
      reading.outcome = ExecutionReading::Outcome::kCompleted;
    if (record.outcome == execution_record_t::OUTCOME_ABORTED)
      reading.outcome = ExecutionReading::Outcome::kAborted;
    reading.reason = record.outcome_reason;
    readings.push_back(reading);
  }
  return readings;
}

program_slot_t toMessage(const Slot& slot) {
  auto message = blank<program_slot_t>();
  if (slot.empty()) return message;
  const PatternSetContent& content = slot.set->content();
  message.execution_id = slot.execution_id;
  message.slot_pattern_id = slot.pattern_id;
  message.slot_set_version = slot.set->version();
  message.command_kind = static_cast<int16_t>(content.kind);
  message.period = static_cast<int32_t>(content.period_us);
  for (const TrackCommand& command : slot.pattern().commands) {
    message.left.push_back(static_cast<float>(command.left));
    message.right.push_back(static_cast<float>(command.right));
  }
  message.num_commands = static_cast<int32_t>(message.left.size());
  return message;
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
