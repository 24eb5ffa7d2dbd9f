// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>

#include "common/bus/bus.hpp"
#include "common/geometry/se2.hpp"
#include "common/messages/operator_beacon.hpp"

namespace tread::operators {

/// Outcome of a request to the robot.
enum class CallResult { kPending, kDone, kRefused };

/// An operator's request, repeated until the robot shows that it was served.
/** It subscribes to its bus, so it must live until the bus is no longer handled. */
class Call {
 public:
  virtual ~Call() = default;
  Call() = default;
  Call(const Call&) = delete;
  Call& operator=(const Call&) = delete;

  /// Call about every 20 ms. Sends what is due and evaluates the replies.
  virtual CallResult step(int64_t utime) = 0;
  /// Status line for the operator; the outcome once the call has ended.
  virtual std::string describe(int64_t utime) const = 0;
  /// Whether it holds the robot that it armed.
  virtual bool holds() const { return false; }
  /// A notice for the operator during the call, shown when it changes; empty = none.
  virtual std::string notice() const { return ""; }
  /// Cancelled by the operator: withdraws the request.
  virtual void cancel(int64_t /*utime*/) {}
  /// The program is about to exit, whatever the outcome.
  virtual void letGo(int64_t /*utime*/) {}
};

/// Who requests, and why; both are logged.
struct Requester {
  std::string by = "operator";
  std::string why;
  /// Name of the operator; programs of the same name share the lease.
  std::string operator_name = "operator";

  /// Signature for the log, for instance "ADA (root@station)".
  std::string signature() const {
    return by == operator_name ? by : by + " (" + operator_name + ")";
  }
};

/// Message if no robot is received.
inline const std::string kNoMotor =
    "no MOTOR message came: is tread-motor-bridge running on this LCM URL?";

/// "; the robot has a key: ..." if the robot has a key and this program none, else empty.
std::string keyWords(const Bus& bus);

/// Sends one ARM message; `utime` [us] is the robot's time.
void sendArm(Bus& bus, const Requester& requester, bool arm, int64_t utime, int64_t seq);

/// A request to the motor bridge, repeated until MOTOR shows that it was served.
class PermissionCall : public Call {
 public:
  CallResult step(int64_t utime) override;
  std::string describe(int64_t utime) const override;

 protected:
  struct Request {
    /// `utime` is the robot's time.
    std::function<void(int64_t utime, int64_t seq)> send;
    /// Whether this bridge state (motor_t::STATE_*) shows that the request was served.
    std::function<bool(int16_t bridge_state)> served;
    std::string text_if_served;
    std::string text_if_not;
    int64_t repeat;       ///< [us]
    bool permits = true;  ///< grants permission: void before the robot's time is known
  };
  /// `patience` [s]: how long it is repeated.
  PermissionCall(Bus& bus, const std::string& operator_name, double patience, Request request);

  bool shown(int64_t utime) const;
  /// The reason that the bridge gives for its state.
  const std::string& bridgeReason() const { return motor_.message().state_reason; }
  bool estopped() const {
    return motor_.any() && motor_.message().bridge_state == motor_t::STATE_ESTOP;
  }
  /// Whether the state was reached before this call requested it.
  bool wasSo() const { return was_so_; }

  Bus& bus_;
  OperatorBeacon beacon_;

 private:
  Request request_;
  int64_t patience_;  ///< [us]
  Latest<motor_t> motor_;
  std::optional<int64_t> started_;  ///< [us]
  int64_t next_ = 0;                ///< [us]
  int64_t seq_ = 0;
  bool was_so_ = false;
};

/// A request by tread-arm.
struct ArmOptions {
  bool arm = true;  ///< false: disarm
  /// keep running once armed: the robot may drive only as long as this program runs
  bool hold = false;
  std::string hand_over_to;  ///< name of the operator who takes over; empty = nobody
};

/// Arms or disarms, and meanwhile holds the robot for its operator.
class ArmCall : public PermissionCall {
 public:
  ArmCall(Bus& bus, const Requester& requester, const ArmOptions& request, double patience);

  CallResult step(int64_t utime) override;
  std::string describe(int64_t utime) const override;
  std::string notice() const override;
  bool holds() const override { return armed_ && otherHolder().empty(); }
  /// Disarms a robot that it holds.
  void cancel(int64_t utime) override;
  void letGo(int64_t utime) override { beacon_.letGo(utime); }

 private:
  CallResult handOver(int64_t utime);
  /// Another operator that holds the robot; empty = none.
  std::string otherHolder() const;

  Requester requester_;
  ArmOptions request_;
  HolderWatch holder_;
  std::optional<int64_t> began_;  ///< [us]
  bool waits_ = false;            ///< waits for the hand-over of a robot that it is to hold
  std::optional<int64_t> armed_;  ///< [us] time of arming
};

/// Engages or clears the emergency stop.
class StopCall : public PermissionCall {
 public:
  StopCall(Bus& bus, const Requester& requester, bool engage, double patience);
  std::string describe(int64_t utime) const override;

 private:
  bool engage_;
};

/// Surface name at a point of the map, if known.
using SurfaceNames = std::function<std::string(const Eigen::Vector2d& p_map)>;

/// A planner's status in a word.
std::string statusWord(int16_t plan_status);

/// A goal and its tolerances.
struct GoalRequest {
  Pose2 T_map_goal;
  double position_tolerance = 0.6;  ///< [m]
  double yaw_tolerance = kPi;       ///< [rad]; pi = any heading
  /// [s] the robot may be blocked or the goal unreachable before the call gives up.
  double patience = 30.0;
};

/// Repeats GOAL until the planner has arrived or gives up for good, the permission to drive is
/// lost, or the goal has ended.
class GoalCall : public Call {
 public:
  /// `goal_id` must be new to the planner.
  GoalCall(Bus& bus, const GoalRequest& request, const std::string& operator_name, int64_t goal_id,
           SurfaceNames surface_names);

  CallResult step(int64_t utime) override;
  std::string describe(int64_t utime) const override;
  /// Sends goal 0, which stops the robot, unless the planner follows another goal.
  void cancel(int64_t utime) override;
  void letGo(int64_t utime) override { beacon_.letGo(utime); }

 private:
  void send(int64_t utime, int64_t goal_id);
  bool lostPermission(int64_t utime);
  bool lostGoal(int64_t utime);
  std::string lossWords() const;
  /// "to go 12.3 m  driving  left-soft on gravel  last error 0.04 m 1.2 deg  set 17".
  std::string progress(int64_t utime) const;
  std::string patternName(int32_t id) const;

  Bus& bus_;
  GoalRequest request_;
  int64_t goal_id_;
  SurfaceNames surface_names_;
  OperatorBeacon beacon_;
  HolderWatch holder_;
  Latest<ins_t> ins_;
  Latest<plan_t> plan_;
  Latest<motor_t> motor_;
  Latest<execution_t> execution_;
  Latest<learning_t> learning_;
  std::map<int32_t, std::string> names_;  ///< of patterns by id
  std::optional<int64_t> started_;        ///< [us]
  int64_t next_ = 0;                      ///< [us]
  std::optional<int64_t> stuck_since_;
  bool was_armed_ = false;
  std::optional<int64_t> disarmed_since_;  ///< [us]; none while armed
  bool was_goal_ = false;                  ///< the planner had accepted this goal
  std::optional<int64_t> lost_since_;      ///< [us] since when the planner has dropped it
  int64_t seq_ = 0;
};

}  // namespace tread::operators
