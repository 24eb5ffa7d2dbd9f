// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/planner/kit/closed_loop.hpp"

#include <algorithm>
#include <cmath>
#include <ctime>
#include <deque>
#include <limits>

namespace tread::planner::testkit {

void ToyBridge::receive(int64_t run_id, const PlannedExecution& running,
                        const PlannedExecution& next, int64_t now) {
  run_id_ = run_id;
  if (running.empty() || !armed_) {
    if (!current_.empty()) close(ExecutionOutcome::kAborted, StopReason::kStoppedByPlanner);
    current_ = pending_ = {};
    return;
  }
  if (!current_.empty() && running.execution_id == current_.execution_id) {
    pending_ = next;
  } else if (current_.empty() && running.execution_id > last_id_) {
    begin(running, now);
    pending_ = next;
  }
}

void ToyBridge::begin(const PlannedExecution& slot, int64_t started) {
  current_ = slot;
  pending_ = {};
  started_ = started;
  last_id_ = slot.execution_id;
  ++begun_;
  ExecutionRecord record;
  record.run_id = run_id_;
  record.execution_id = slot.execution_id;
  record.started = started;
  executions_.push_back(record);
  if (executions_.size() > 8) executions_.erase(executions_.begin());
}

void ToyBridge::close(ExecutionOutcome outcome, const Reason& reason) {
  executions_.back().outcome = outcome;
  executions_.back().reason = reason;
}

Command ToyBridge::step(int64_t now) {
  while (!current_.empty() && now >= started_ + current_.durationUs()) {
    const int64_t end = started_ + current_.durationUs();
    close(ExecutionOutcome::kCompleted, {});
    const PlannedExecution next = pending_;
    current_ = {};
    if (!next.empty()) begin(next, end);
  }
  reading_ = {};
  reading_.utime = now;
  reading_.state = !armed_            ? BridgeState::kDisarmed
                   : current_.empty() ? BridgeState::kArmed
                                      : BridgeState::kDriving;
  reading_.run_id = run_id_;
  reading_.execution_id = current_.execution_id;
  if (current_.empty()) return {0.0, 0.0};
  reading_.command_index = static_cast<int>((now - started_) / current_.set->content().period_us);
  return current_.pattern().commands[static_cast<size_t>(reading_.command_index)];
}

namespace {

constexpr int64_t kTick = 10'000;
constexpr int64_t kPlannerPeriod = 50'000;
constexpr int64_t kScanPeriod = 100'000;

struct Orders {
  int64_t due;
  PlannedExecution running;
  PlannedExecution next;
};

/// A drive in progress.
class Drive {
 public:
  Drive(Mission mission, const PatternSet& set, const DriveOptions& options)
      : mission_(std::move(mission)),
        options_(options),
        supervisor_(options.config, 77),
        mapping_(options.seed),
        random_(options.seed) {
    supervisor_.takeSet(set);
    state_.pose = mission_.T_map_start;
    if (!options.whole_map_known) return;
    const Grid grid = mission_.ground.paint(ToyMapping::kCell, {-16.0, -16.0}, {48.0, 16.0});
    for (const Tile& tile : tilesOf(grid, ToyMapping::kTileCells, 1))
      supervisor_.map().put(tile, ToyMapping::kCell, ToyMapping::kTileCells);
  }

  DriveOutcome run() {
    outcome_.least_clearance = std::numeric_limits<double>::infinity();
    const auto limit = static_cast<int64_t>(options_.time_limit * 1e6);
    for (now_ = kStart; now_ < kStart + limit && !done_; now_ += kTick) {
      moveVehicle();
      if (now_ % kScanPeriod == 0) map();
      if (now_ % kPlannerPeriod == 0) plan();
    }
    outcome_.time = static_cast<double>(now_ - kStart) * 1e-6;
    outcome_.patterns = bridge_.begun();
    outcome_.counters = supervisor_.counters();
    return outcome_;
  }

 private:
  static constexpr int64_t kStart = 10'000'000;

  double normal(double sigma) { return std::normal_distribution<double>(0.0, sigma)(random_); }

  void moveVehicle() {
    while (!orders_.empty() && orders_.front().due <= now_) {
      bridge_.receive(77, orders_.front().running, orders_.front().next, now_);
      orders_.pop_front();
    }
    const Command command = bridge_.step(now_);
    if (bridge_.executionId() != drawn_for_) {
      drawn_for_ = bridge_.executionId();
      gain_ = 1.0 + normal(options_.errors.gain);
      turn_ = options_.errors.turn_bias * (1.0 + normal(options_.errors.turn));
      drift_ = normal(options_.errors.drift);
    }
    const Pose2 before = state_.pose;
    state_ = moveOn(state_, command, static_cast<double>(kTick) * 1e-6, options_.vehicle, gain_,
                    turn_, drift_);
    const Pose2 moved = between(before, state_.pose);
    const double dt = static_cast<double>(kTick) * 1e-6;
    twist_ = {moved.x / dt, moved.y / dt, moved.yaw / dt};
    outcome_.distance += std::hypot(moved.x, moved.y);
    readings_.push_back({now_, state_.pose, twist_});
    while (readings_.front().utime < now_ - options_.latency) readings_.pop_front();
  }

  void map() {
    if (options_.whole_map_known) {
      Tile tick{1000, 1000, now_,
                std::vector<Cell>(ToyMapping::kTileCells * ToyMapping::kTileCells, kUnknown)};
      supervisor_.map().put(tick, ToyMapping::kCell, ToyMapping::kTileCells);
      return;
    }
    for (Tile& tile : mapping_.scan(mission_.ground, state_.pose, now_))
      supervisor_.map().put(std::move(tile), ToyMapping::kCell, ToyMapping::kTileCells);
  }

  PlannerInputs inputs() {
    PlannerInputs s;
    s.now = now_;
    PoseReading pose = readings_.front();
    pose.T_map_body.x += normal(options_.errors.pose_noise);
    pose.T_map_body.y += normal(options_.errors.pose_noise);
    pose.T_map_body.yaw += normal(options_.errors.pose_noise / 3.0);
    s.pose = pose;
    s.bridge = bridge_.reading();
    s.executions = bridge_.executions();
    s.goal = mission_.goal;
    s.armed_by_operator = true;
    s.set_received = now_;
    return s;
  }

  void plan() {
    const PlannerInputs s = inputs();
    const std::clock_t before = std::clock();
    const Decision decision = supervisor_.step(s, nullptr);
    const double took = static_cast<double>(std::clock() - before) / CLOCKS_PER_SEC;
    outcome_.planner_seconds += took;
    outcome_.worst_step = std::max(outcome_.worst_step, took);
    outcome_.status = decision.report.status;
    outcome_.reason = decision.report.reason.words;
    orders_.push_back(
        {now_ + options_.latency, supervisor_.program().running(), supervisor_.program().next()});
    const double clearance = mission_.ground.clearance(options_.config.map.footprint, state_.pose);
    outcome_.least_clearance = std::min(outcome_.least_clearance, clearance);
    if (clearance <= 0.0) ++outcome_.collisions;
    done_ = decision.report.status == PlanStatus::kArrived;
    if (options_.on_decision)
      options_.on_decision(static_cast<double>(now_ - kStart) * 1e-6, decision);
    if (options_.on_step)
      options_.on_step(static_cast<double>(now_ - kStart) * 1e-6, state_.pose, supervisor_,
                       mission_.ground);
  }

  Mission mission_;
  DriveOptions options_;
  Supervisor supervisor_;
  ToyMapping mapping_;
  ToyBridge bridge_;
  std::mt19937_64 random_;
  TrackState state_;
  Twist2 twist_;
  std::deque<PoseReading> readings_;
  std::deque<Orders> orders_;
  int64_t now_ = 0;
  int64_t drawn_for_ = -1;
  double gain_ = 1.0;
  double turn_ = 1.0;
  double drift_ = 0.0;
  bool done_ = false;
  DriveOutcome outcome_;
};

}  // namespace

DriveOutcome driveMission(Mission mission, const PatternSet& set, const DriveOptions& options) {
  return Drive(std::move(mission), set, options).run();
}

}  // namespace tread::planner::testkit
