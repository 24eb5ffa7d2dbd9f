// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <deque>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "common/execution/bridge_state.hpp"
#include "common/execution/execution_record.hpp"
#include "common/geometry/track.hpp"
#include "common/pattern/pattern.hpp"

namespace tread {

/// (run id, execution id): a permanent name of one execution.
using ExecutionKey = std::pair<int64_t, int64_t>;

/// A measured pose of the vehicle.
struct PoseReading : TimedPose {
  std::optional<Twist2> twist;                                     ///< v_body, if it is measured
  double position_std = std::numeric_limits<double>::quiet_NaN();  ///< [m] per axis
  /// [rad] of the ground, from the attitude
  double slope = std::numeric_limits<double>::quiet_NaN();
};

/// State reported by the motor bridge.
struct BridgeReading {
  int64_t utime = 0;  ///< [us] when it gave its last command
  BridgeState state = BridgeState::kDisarmed;
  Reason reason;
  int64_t run_id = 0;
  int64_t execution_id = 0;  ///< being played; 0 = none
  int command_index = -1;

  /// Whether it may drive without being armed again.
  bool armed() const { return isArmed(state); }
};

/// What the driving process knows about the robot at one instant.
struct RobotReadings {
  int64_t now = 0;  ///< [us]
  std::optional<PoseReading> pose;
  std::optional<BridgeReading> bridge;
  std::vector<ExecutionRecord> executions;  ///< the last ones, oldest first
  bool armed_by_operator = false;  ///< an ARM was received since the start and since the last stop
  int64_t armed_since = 0;         ///< [us] when it came
  bool estopped = false;
};

/// A pattern handed over to the motor bridge, with the set that predicted it.
struct PlannedExecution {
  int64_t execution_id = 0;  ///< counts up within a run; 0 = empty
  int pattern_id = 0;
  std::optional<PatternSet> set;  ///< keeps its version even after a newer one has arrived

  bool empty() const { return execution_id == 0; }
  const MotionPattern& pattern() const { return *set->find(pattern_id); }
  int64_t durationUs() const {
    return set->content().period_us * static_cast<int64_t>(pattern().commands.size());
  }
};

/// Tracks which patterns were handed over to the motor bridge and which of them it executes.
/** The bridge continues with `next` after `running` by itself. The tracker advances when MOTOR or
 * EXECUTION reports it or, if they are late, when the running pattern must have ended. */
class ExecutionTracker {
 public:
  explicit ExecutionTracker(int64_t run_id) : run_id_(run_id) {}

  /// What happened to the running pattern.
  enum class Event { kNone, kSwitched, kEnded, kAborted, kNeverStarted };

  /// Hands over a pattern to a standing vehicle.
  void begin(const PatternSet& set, int pattern_id, int64_t now);
  /// Hands over the pattern that follows; the same pattern of the same set again keeps its slot.
  void setNext(const PatternSet& set, int pattern_id);
  void clearNext();
  /// Empties both slots: stop now.
  void stop();
  /// Updates the tracker from MOTOR and EXECUTION. Call it first in each step.
  Event follow(const RobotReadings& readings);

  /// Why a set cannot replace the one in use: it lacks a pattern that was handed over, or has other
  /// commands for it. Empty if it can.
  std::string conflictWith(const PatternSet& set) const;

  const PlannedExecution& running() const { return running_; }
  const PlannedExecution& next() const { return next_; }
  /// The bridge has begun the running pattern.
  bool confirmed() const { return confirmed_; }
  /// [us] best estimate of the start of the running pattern.
  int64_t started() const { return started_; }
  int64_t ends() const { return started_ + running_.durationUs(); }
  int64_t runId() const { return run_id_; }
  /// Why the last execution was aborted, in words.
  const Reason& abortReason() const { return abort_reason_; }

 private:
  Event followMotor(const RobotReadings& readings);
  Event followExecutions(const RobotReadings& readings);
  Event followTime(int64_t now);
  void advanceTo(const PlannedExecution& to, int64_t started);
  Event finish(Event event, const Reason& reason);
  bool adopt(int64_t execution_id, int64_t started);

  int64_t run_id_;
  int64_t last_id_ = 0;
  PlannedExecution running_;
  PlannedExecution next_;
  /// Former next ones; the bridge may have started one of them
  std::deque<PlannedExecution> replaced_;
  int64_t previous_id_ = 0;
  int64_t handed_over_ = 0;
  int64_t started_ = 0;
  bool confirmed_ = false;
  Reason abort_reason_;
};

}  // namespace tread
