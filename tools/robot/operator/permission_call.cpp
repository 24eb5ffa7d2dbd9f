// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/operator/permission_call.hpp"

#include <utility>

#include "common/messages/blank.hpp"
#include "common/messages/execution_messages.hpp"

namespace tread::operators {
namespace {

constexpr int64_t kArmRepeat = 100'000;  // [us]
constexpr int64_t kStopRepeat = 50'000;  // [us]
constexpr int64_t kFreshAge = 500'000;   // [us] a MOTOR message older than this shows nothing
/// An answer counts only after this long: what came before the call is no answer.
constexpr int64_t kSettle = 200'000;  // [us]

}  // namespace

PermissionCall::PermissionCall(Bus& bus, double patience, Request request)
    : request_(std::move(request)),
      patience_(static_cast<int64_t>(patience * 1e6)),
      motor_(bus, kMotor) {}

bool PermissionCall::shown(int64_t utime) const {
  return motor_.any() && motor_.age(utime) < kFreshAge &&
         request_.served(motor_.message().bridge_state);
}

CallResult PermissionCall::step(int64_t utime) {
  if (!started_) started_ = utime;
  if (utime - *started_ > kSettle && shown(utime)) return CallResult::kDone;
  if (utime - *started_ > patience_) return CallResult::kRefused;
  if (utime < next_) return CallResult::kPending;
  next_ = utime + request_.repeat;
  request_.send(utime, seq_++);
  return CallResult::kPending;
}

std::string PermissionCall::describe(int64_t utime) const {
  if (shown(utime)) return request_.text_if_served;
  const std::string words = request_.text_if_not + "; ";
  if (!motor_.any())
    return words + "no MOTOR message came: is tread-motor-bridge running on this LCM URL?";
  if (motor_.age(utime) > kFreshAge)
    return words + "MOTOR has fallen silent: look at tread-motor-bridge";
  const std::string& reason = motor_.message().state_reason;
  return words + "the motor bridge says: " + (reason.empty() ? "nothing" : reason);
}

ArmCall::ArmCall(Bus& bus, const Requester& requester, bool arm, double patience)
    : PermissionCall(bus, patience,
                     {[&bus, requester, arm](int64_t utime, int64_t seq) {
                        auto message = blank<arm_t>();
                        message.utime = utime;
                        message.seq = seq;
                        message.armed = arm;
                        message.armed_by = requester.by;
                        message.arm_reason = requester.why;
                        bus.publish(kArm, message);
                      },
                      [arm](int16_t bridge_state) { return mayDrive(bridge_state) == arm; },
                      arm ? "armed" : "disarmed", arm ? "not armed" : "not disarmed", kArmRepeat}) {
}

StopCall::StopCall(Bus& bus, const Requester& requester, bool engage, double patience)
    : PermissionCall(bus, patience,
                     {[&bus, requester, engage](int64_t utime, int64_t seq) {
                        auto message = blank<estop_t>();
                        message.utime = utime;
                        message.seq = seq;
                        message.engaged = engage;
                        message.estop_by = requester.by;
                        message.estop_reason = requester.why;
                        bus.publish(kEstop, message);
                      },
                      [engage](int16_t bridge_state) {
                        return (bridge_state == motor_t::STATE_ESTOP) == engage;
                      },
                      engage ? "stopped; tread-stop --clear, then tread-arm, to go on"
                             : "emergency stop cleared; tread-arm to go on",
                      engage ? "NOBODY CONFIRMS THE STOP" : "not cleared", kStopRepeat}) {}

}  // namespace tread::operators
