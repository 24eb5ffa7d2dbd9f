// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/messages/robot_inputs.hpp"

#include <algorithm>
#include <cstdlib>
#include <limits>
#include <string>

#include "common/messages/blank.hpp"
#include "common/messages/ins_messages.hpp"
#include "common/messages/pattern_messages.hpp"

namespace tread {

void DrivingPermission::revoke(int64_t utime) {
  armed_ = false;
  revoked_ = std::max(revoked_, utime);
}

void DrivingPermission::take(const arm_t& message, int64_t now) {
  if (!message.armed) return revoke(std::min(message.utime, now));
  const bool timely = message.utime <= now + kMaxFuture && message.utime >= now - kMaxAge;
  if (!timely || message.utime <= revoked_ || estopped_) return;
  if (!granted()) armed_by_ = message.armed_by;
  if (armed_) return;
  armed_ = true;
  armed_since_ = now;
}

void DrivingPermission::take(const estop_t& message, int64_t now) {
  // A stop counts whatever its time; only clearing must be newer than the stop.
  const int64_t utime = std::min(message.utime, now);
  if (!message.engaged && utime < estop_utime_) return;
  estop_utime_ = std::max(estop_utime_, utime);
  estopped_ = message.engaged;
  if (estopped_) revoke(utime);
}

void DrivingPermission::take(const BridgeReading& bridge, int64_t now) {
  if (bridge_armed_ && !bridge.armed()) revoke(bridge.utime);
  if (!bridge_armed_ && bridge.armed()) armed_since_ = now;
  bridge_armed_ = bridge.armed();
}

RobotInputs::RobotInputs(Bus& bus, HealthReporter& health, int64_t operator_lease_us)
    : bus_(bus), health_(health), permission_(bus.now()), operator_(operator_lease_us) {
  bus.subscribe<ins_t>(kIns, [this](const ins_t& message) { take(message); });
  bus.subscribe<motor_t>(kMotor, [this](const motor_t& message) { take(message); });
  bus.subscribe<execution_t>(kExecution, [this](const execution_t& message) { take(message); });
  bus.subscribe<operator_t>(kOperator, [this](const operator_t& message) { take(message); });
  bus.subscribe<arm_t>(kArm, [this](const arm_t& message) { take(message); });
  bus.subscribe<estop_t>(kEstop,
                         [this](const estop_t& message) { permission_.take(message, bus_.now()); });
}

bool RobotInputs::timeJumped(int64_t utime) {
  // A process without a clock of its own does not know the time at first, and may be frozen later.
  const bool jumped = stepped_ && std::abs(utime - *stepped_) > kTimeJump;
  stepped_ = utime;
  operator_.update(utime, permission_.armed());
  if (jumped) permission_.restart(utime);
  return jumped;
}

RobotReadings RobotInputs::readings(int64_t utime) const {
  RobotReadings readings = readings_;
  readings.now = utime;
  readings.armed_by_operator = permission_.armed();
  readings.armed_since = permission_.armedSince();
  readings.estopped = permission_.estopped();
  return readings;
}

bool RobotInputs::invalidTime(int64_t utime, const char* channel) {
  const bool future = utime > bus_.now() + kMaxFuture;
  if (utime > 0 && !future) return false;
  health_.addToCounter(std::string(channel) +
                       (future ? " refused: from the future" : " refused: no such time"));
  return true;
}

bool RobotInputs::untimely(int64_t utime, const char* channel) {
  if (invalidTime(utime, channel)) return true;
  if (utime >= bus_.now() - kMaxAge) return false;
  health_.addToCounter(std::string(channel) + " refused: too old");
  return true;
}

void RobotInputs::take(const arm_t& message) {
  const bool before = permission_.granted();
  permission_.take(message, bus_.now());
  takeHolder(before);
}

/// The motor bridge arms only for the holder. The operator it is armed for is therefore the holder,
/// even if this process started at another time and received another operator first.
void RobotInputs::takeHolder(bool granted_before) {
  if (!granted_before && permission_.granted()) operator_.holdBy(permission_.armedBy(), bus_.now());
}

void RobotInputs::take(const operator_t& message) {
  const std::optional<OperatorNotice> notice = noticeFrom(message);
  if (!notice) return health_.addToCounter("OPERATOR ignored: its name is empty or too long");
  const OperatorLease::Receipt receipt = operator_.receive(*notice, bus_.now());
  if (receipt != OperatorLease::Receipt::kTaken)
    health_.addToCounter(std::string("OPERATOR ignored: ") + describe(receipt));
}

void RobotInputs::take(const ins_t& message) {
  if (invalidTime(message.utime, "INS")) return;
  if (on_ins) on_ins(message);
  const std::optional<Pose2> pose = planarPose(message);
  if (!pose) return health_.addToCounter("INS without a pose");
  if (readings_.pose && message.utime <= readings_.pose->utime)
    return health_.addToCounter("INS out of order");
  readings_.pose = PoseReading{message.utime, *pose, planarTwist(message), horizontalStd(message),
                               tilt(message).inclination};
}

void RobotInputs::take(const motor_t& message) {
  if (invalidTime(message.utime, "MOTOR")) return;
  if (on_motor) on_motor(message);
  if (readings_.bridge && message.utime < readings_.bridge->utime) return;
  readings_.bridge = readingFrom(message);
  const bool before = permission_.granted();
  permission_.take(*readings_.bridge, bus_.now());
  takeHolder(before);
}

void RobotInputs::take(const execution_t& message) {
  if (invalidTime(message.utime, "EXECUTION")) return;
  if (on_execution) on_execution(message);
  if (message.utime < executions_utime_) return;
  executions_utime_ = message.utime;
  readings_.executions = recordsFrom(message);
}

program_t programOf(const ExecutionTracker& tracker, const Bus& bus, int64_t utime, int64_t seq,
                    int64_t lease_us) {
  auto message = blank<program_t>();
  message.utime = utime;
  message.seq = seq;
  message.run_id = tracker.runId();
  message.lease = static_cast<int32_t>(lease_us);
  message.running = toMessage(tracker.running());
  message.next = toMessage(tracker.next());
  const BusStatistics& statistics = bus.statistics();
  message.inputs_heard = statistics.received;
  message.newest_input = statistics.newest.channel;
  message.newest_input_utime = statistics.newest.utime;
  message.newest_input_seq = statistics.newest.seq;
  return message;
}

}  // namespace tread
