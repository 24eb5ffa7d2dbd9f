// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/report/drive_record.hpp"

#include <cmath>
#include <set>

#include "common/log/drive_log.hpp"
#include "common/messages/ins_messages.hpp"

namespace tread::report {
namespace {

/// The last plans before the goal are short; the richest one made farther away [m] is drawn.
constexpr double kNear = 8.0;
constexpr double kTrackStep = 0.05;  // [m]

bool mayDrive(int16_t state) {
  return state == motor_t::STATE_ARMED || state == motor_t::STATE_DRIVING ||
         state == motor_t::STATE_STOPPING;
}

/// Takes in a log event by event.
class Reader {
 public:
  explicit Reader(DriveRecord& drive) : drive_(drive) {}

  void take(const LogEvent& event) {
    ++drive_.events;
    drive_.latencies.add(event);
    dispatch(
        event, [&](const auto& message) { hear(message); }, kIns, kGoal, kPlan, kPlanTree, kMap,
        kLearning, kExecution, kMotor);
  }

 private:
  double sinceBegin(int64_t utime) const {
    return static_cast<double>(utime - drive_.begun) * 1e-6;
  }
  double toGo() const {
    if (drive_.track.empty()) return 0.0;
    return (drive_.track.back().T_map_body.position() - drive_.T_map_goal.position()).norm();
  }

  void hear(const ins_t& ins) {
    const auto pose = planarPose(ins);
    if (!pose || !drive_.has_goal || drive_.arrived) return;
    drive_.ended = ins.utime;
    if (drive_.track.empty() ||
        (drive_.track.back().T_map_body.position() - pose->position()).norm() > kTrackStep)
      drive_.track.push_back({sinceBegin(ins.utime), *pose});
  }
  void hear(const goal_t& goal) {
    if (goal.goal_id == 0 || drive_.arrived) return;
    if (!drive_.has_goal) drive_.begun = drive_.ended = goal.utime;
    drive_.has_goal = true;
    drive_.T_map_goal = {goal.goal_pose[0], goal.goal_pose[1], goal.goal_pose[2]};
  }
  void hear(const plan_t& plan) {
    if (!drive_.has_goal || drive_.arrived || plan.goal_id == 0) return;
    drive_.last_status = plan.reason;
    if (plan.plan_status != plan_t::PLAN_ARRIVED) return;
    drive_.arrived = true;
    drive_.ended = plan.utime;
  }
  void hear(const plan_tree_t& tree) {
    std::vector<report::TreeEdge> edges = report::edgesOf(tree);
    if (toGo() > kNear && edges.size() >= drive_.tree.size()) drive_.tree = std::move(edges);
  }
  void hear(const map_tile_t& message) {
    if (!drive_.map) drive_.map = std::make_unique<TileMap>(message.cell_size, message.tile_cells);
    if (message.tile_cells != drive_.map->tileCells()) return;
    Tile tile;
    tile.tile_x = message.tile_x;
    tile.tile_y = message.tile_y;
    tile.utime = message.utime;
    tile.cells = message.cells;
    drive_.map->put(std::move(tile));
  }
  void hear(const learning_t& message) {
    if (!message.accepted) ++drive_.refused;
    if (message.accepted && std::isfinite(message.error_position))
      drive_.errors.push_back(
          {sinceBegin(message.utime), message.error_position, message.error_yaw});
  }
  void hear(const execution_t& message) {
    for (const execution_record_t& record : message.records) {
      if (record.outcome == execution_record_t::OUTCOME_RUNNING) continue;
      if (!ended_.insert(keyOf(record)).second) continue;
      ++(record.outcome == execution_record_t::OUTCOME_COMPLETED ? drive_.completed
                                                                 : drive_.aborted);
    }
  }
  void hear(const motor_t& motor) {
    const bool may = mayDrive(motor.bridge_state);
    if (may_drive_ && !may && !drive_.arrived) ++drive_.disarmed;
    may_drive_ = may;
  }

  DriveRecord& drive_;
  std::set<ExecutionKey> ended_;
  bool may_drive_ = false;
};

}  // namespace

double DriveRecord::distance() const {
  double sum = 0.0;
  for (size_t i = 1; i < track.size(); ++i)
    sum += (track[i].T_map_body.position() - track[i - 1].T_map_body.position()).norm();
  return sum;
}

double DriveRecord::straightLine() const {
  if (track.empty()) return 0.0;
  return (track.front().T_map_body.position() - T_map_goal.position()).norm();
}

DriveRecord readDrive(const std::vector<std::string>& logs) {
  DriveRecord drive;
  Reader reader(drive);
  LogEvent event;
  for (const std::string& path : logs) {
    LogReader log(path);
    while (log.next(event)) reader.take(event);
    if (drive.problem.empty()) drive.problem = log.problem();
  }
  return drive;
}

}  // namespace tread::report
