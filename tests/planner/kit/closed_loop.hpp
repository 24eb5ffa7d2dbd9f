// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <string>

#include "modules/planner/core/execution/supervisor.hpp"
#include "tests/planner/kit/playground.hpp"
#include "tests/planner/kit/sample_patterns.hpp"
#include "tests/planner/kit/vehicle.hpp"

namespace tread::planner::testkit {

/// Plays slots at their period and joins them without a gap, as motor_bridge does, but without its
/// checks.
class ToyBridge {
 public:
  /// The planner's program, received at now [us].
  void receive(int64_t run_id, const PlannedExecution& running, const PlannedExecution& next,
               int64_t now);
  /// The command at `now`.
  Command step(int64_t now);
  void setArmed(bool armed) { armed_ = armed; }

  BridgeReading reading() const { return reading_; }
  const std::vector<ExecutionRecord>& executions() const { return executions_; }
  int64_t executionId() const { return current_.execution_id; }
  int begun() const { return begun_; }

 private:
  void begin(const PlannedExecution& slot, int64_t started);
  void close(ExecutionOutcome outcome, const Reason& reason);

  bool armed_ = true;
  int64_t run_id_ = 0;
  int64_t last_id_ = 0;
  int begun_ = 0;
  int64_t started_ = 0;
  PlannedExecution current_;
  PlannedExecution pending_;
  BridgeReading reading_;
  std::vector<ExecutionRecord> executions_;
};

/// Deviation of the ground from the learned set: standard deviations, drawn for each execution.
struct GroundErrors {
  double gain = 0.05;         ///< [1] of the distance
  double turn = 0.05;         ///< [1] of the turn
  double drift = 0.02;        ///< [rad] sideways
  double turn_bias = 1.0;     ///< [1] factor on all turns relative to the learned set
  double pose_noise = 0.003;  ///< [m], and a third of it in radians
};

/// Result of a closed-loop drive.
struct DriveOutcome {
  PlanStatus status = PlanStatus::kIdle;
  std::string reason;
  double time = 0.0;             ///< [s]
  double distance = 0.0;         ///< [m]
  double least_clearance = 0.0;  ///< [m] between footprint and obstacles; 0 = contact
  int patterns = 0;
  int collisions = 0;            ///< steps with a contact of the footprint
  double planner_seconds = 0.0;  ///< processor time of all steps
  double worst_step = 0.0;       ///< [s] processor time
  std::map<std::string, int64_t> counters;
};

/// Options of a drive.
struct DriveOptions {
  PlannerConfig config = usualPlanner();
  GroundErrors errors;
  TrackModel vehicle;
  uint64_t seed = 1;
  double time_limit = 300.0;  ///< [s]
  bool whole_map_known = false;
  int64_t latency = 20'000;  ///< [us] from measurement to planner, and from planner to bridge
  /// Called every 50 ms with the time [s] and the true pose; may change the world or the set.
  std::function<void(double, const Pose2&, Supervisor&, Playground&)> on_step;
  std::function<void(double, const Decision&)> on_decision;
};

/// Drives a mission in virtual time: kinematic vehicle, toy mapping, toy bridge, the real
/// supervisor.
DriveOutcome driveMission(Mission mission, const PatternSet& set, const DriveOptions& options);

}  // namespace tread::planner::testkit
