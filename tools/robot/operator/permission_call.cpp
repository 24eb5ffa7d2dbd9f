// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/operator/permission_call.hpp"

#include <utility>

#include "common/messages/blank.hpp"

namespace tread::operators {
namespace {

constexpr int64_t kArmRepeat = 100'000;  // [us]
constexpr int64_t kStopRepeat = 50'000;  // [us]
constexpr int64_t kFreshAge = 500'000;   // [us] a MOTOR message older than this shows nothing
/// An answer counts only after this long: what came before the call is no answer.
constexpr int64_t kSettle = 200'000;  // [us]

}  // namespace

PermissionCall::PermissionCall(Bus& bus, double patience, int64_t repeat)
    : bus_(bus),
      patience_(static_cast<int64_t>(patience * 1e6)),
      repeat_(repeat),
      motor_(bus, kMotor) {}

bool PermissionCall::shown(int64_t utime) const {
  return motor_.any() && motor_.age(utime) < kFreshAge && served(motor_.message().bridge_state);
}

CallResult PermissionCall::step(int64_t utime) {
  if (begun_ < 0) begun_ = utime;
  if (utime - begun_ > kSettle && shown(utime)) return CallResult::kDone;
  if (utime - begun_ > patience_) return CallResult::kRefused;
  if (utime < next_) return CallResult::kGoesOn;
  next_ = utime + repeat_;
  send(bus_, utime, seq_++);
  return CallResult::kGoesOn;
}

std::string PermissionCall::words(int64_t utime) const {
  if (shown(utime)) return wordsWhenServed();
  std::string words = wordsWhenNot() + "; ";
  if (!motor_.any())
    return words + "no MOTOR message came: is tread-motor-bridge running on this LCM URL?";
  if (motor_.age(utime) > kFreshAge)
    return words + "MOTOR has fallen silent: look at tread-motor-bridge";
  const std::string& reason = motor_.message().state_reason;
  return words + "the motor bridge says: " + (reason.empty() ? "nothing" : reason);
}

ArmCall::ArmCall(Bus& bus, Asker asker, bool arm, double patience)
    : PermissionCall(bus, patience, kArmRepeat), asker_(std::move(asker)), arm_(arm) {}

void ArmCall::send(Bus& bus, int64_t utime, int64_t seq) {
  auto message = blank<arm_t>();
  message.utime = utime;
  message.seq = seq;
  message.armed = arm_;
  message.armed_by = asker_.by;
  message.arm_reason = asker_.why;
  bus.publish(kArm, message);
}

bool ArmCall::served(int16_t bridge_state) const {
  const bool armed = bridge_state == motor_t::STATE_ARMED ||
                     bridge_state == motor_t::STATE_DRIVING ||
                     bridge_state == motor_t::STATE_STOPPING;
  return armed == arm_;
}

std::string ArmCall::wordsWhenServed() const {
  return arm_ ? "armed" : "disarmed";
}

std::string ArmCall::wordsWhenNot() const {
  return arm_ ? "not armed" : "not disarmed";
}

StopCall::StopCall(Bus& bus, Asker asker, bool engage, double patience)
    : PermissionCall(bus, patience, kStopRepeat), asker_(std::move(asker)), engage_(engage) {}

void StopCall::send(Bus& bus, int64_t utime, int64_t seq) {
  auto message = blank<estop_t>();
  message.utime = utime;
  message.seq = seq;
  message.engaged = engage_;
  message.estop_by = asker_.by;
  message.estop_reason = asker_.why;
  bus.publish(kEstop, message);
}

bool StopCall::served(int16_t bridge_state) const {
  return (bridge_state == motor_t::STATE_ESTOP) == engage_;
}

std::string StopCall::wordsWhenServed() const {
  return engage_ ? "stopped; tread-stop --clear, then tread-arm, to go on"
                 : "emergency stop cleared; tread-arm to go on";
}

std::string StopCall::wordsWhenNot() const {
  return engage_ ? "NOBODY CONFIRMS THE STOP" : "not cleared";
}

}  // namespace tread::operators
