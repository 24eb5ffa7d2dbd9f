// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <functional>
#include <optional>
#include <string>

#include <tread/arm_t.hpp>
#include <tread/estop_t.hpp>
#include <tread/ins_t.hpp>
#include <tread/program_t.hpp>

#include "common/bus/bus.hpp"
#include "common/execution/execution_tracker.hpp"
#include "common/messages/operator_beacon.hpp"

namespace tread {

/// Whether the operator allows this run of a process to drive.
/** A permission counts if it was given after the process started and after the last event that
 * revoked it: an order to disarm, an emergency stop, or a motor bridge that is no longer armed. */
class DrivingPermission {
 public:
  explicit DrivingPermission(int64_t start) : revoked_(start) {}
  /// As if started at this time.
  void restart(int64_t utime) { revoke(utime); }

  void take(const arm_t& message, int64_t now);
  void take(const estop_t& message, int64_t now);
  void take(const BridgeReading& bridge, int64_t now);

  bool armed() const { return armed_; }
  /// [us] since when the permission has held and the motor bridge has accepted it; an ARM that it
  /// refuses does not count.
  int64_t armedSince() const { return armed_since_; }
  /// Whether the motor bridge has accepted the permission.
  bool granted() const { return armed_ && bridge_armed_; }
  /// The sender of the accepted ARM.
  const std::string& armedBy() const { return armed_by_; }
  bool estopped() const { return estopped_; }

 private:
  static constexpr int64_t kMaxAge = 1'500'000;  ///< [us] ARM is repeated for a second
  static constexpr int64_t kMaxFuture = 50'000;  ///< [us]
  void revoke(int64_t utime);

  int64_t revoked_;  ///< [us] permissions given earlier do not count
  bool armed_ = false;
  int64_t armed_since_ = 0;
  std::string armed_by_;
  bool bridge_armed_ = false;
  bool estopped_ = false;
  int64_t estop_utime_ = 0;
};

/// Receives INS, MOTOR, EXECUTION, OPERATOR, ARM and ESTOP for a node that drives the robot.
/** Messages with an impossible time, out of order or without a pose are refused and counted in
 * HEALTH. Starts without permission: ARM must be received after the start. */
class RobotInputs {
 public:
  RobotInputs(Bus& bus, HealthReporter& health, int64_t operator_lease_us);
  RobotInputs(const RobotInputs&) = delete;  // the bus calls it back
  RobotInputs& operator=(const RobotInputs&) = delete;

  /// Call first in each step. True if the time jumped: earlier notes have no age any more, and the
  /// permission is revoked, because it was given to another run.
  bool timeJumped(int64_t utime);
  RobotReadings readings(int64_t utime) const;
  DrivingPermission& permission() { return permission_; }
  const OperatorLease& operatorLease() const { return operator_; }

  /// Whether a time is impossible: not positive, or so far ahead that the message would look fresh
  /// forever.
  /** Counted in HEALTH as refused on that channel. */
  bool invalidTime(int64_t utime, const char* channel);
  /// The same for messages that must be recent, like a permission.
  bool untimely(int64_t utime, const char* channel);

  // Called with each message whose time is possible, before it is used.
  std::function<void(const ins_t&)> on_ins;
  std::function<void(const motor_t&)> on_motor;
  std::function<void(const execution_t&)> on_execution;

 private:
  static constexpr int64_t kTimeJump = 1'000'000;  ///< [us] between two steps
  static constexpr int64_t kMaxFuture = 100'000;   ///< [us] by which a utime may be ahead
  static constexpr int64_t kMaxAge = 1'500'000;    ///< [us] of messages that must be recent

  void take(const operator_t& message);
  void take(const arm_t& message);
  void takeHolder(bool granted_before);
  void take(const ins_t& message);
  void take(const motor_t& message);
  void take(const execution_t& message);

  Bus& bus_;
  HealthReporter& health_;
  DrivingPermission permission_;
  OperatorLease operator_;
  RobotReadings readings_;
  std::optional<int64_t> stepped_;  ///< [us] the last step
  int64_t executions_utime_ = 0;
};

/// PROGRAM with both slots of the tracker and the newest input of the bus.
program_t programOf(const ExecutionTracker& tracker, const Bus& bus, int64_t utime, int64_t seq,
                    int64_t lease_us);

}  // namespace tread
