// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/operator/permission_call.hpp"

#include <utility>

namespace tread::operators {
namespace {

constexpr int64_t kRepeat = 100'000;    // [us]
constexpr int64_t kFreshAge = 500'000;  // [us] a MOTOR message older than this shows nothing
/// An answer counts only after this long: what came before the call is no answer.
constexpr int64_t kSettle = 200'000;  // [us]

int64_t micro(double seconds) {
  return static_cast<int64_t>(seconds * 1e6);
}

std::string stateWords(const Latest<motor_t>& motor, int64_t utime) {
  if (!motor.any()) return "no MOTOR message came: is tread-motor-bridge running on this LCM URL?";
  if (motor.age(utime) > kFreshAge) return "MOTOR has fallen silent: look at tread-motor-bridge";
  const std::string& reason = motor.message().state_reason;
  return "the motor bridge says: " + (reason.empty() ? "nothing" : reason);
}

}  // namespace

ArmCall::ArmCall(Bus& bus, Asker asker, bool arm, double patience)
    : bus_(bus),
      asker_(std::move(asker)),
      arm_(arm),
      patience_(micro(patience)),
      motor_(bus, kMotor) {}

bool ArmCall::shown() const {
  const int16_t state = motor_.message().bridge_state;
  const bool armed = state == motor_t::STATE_ARMED || state == motor_t::STATE_DRIVING;
  return armed == arm_;
}

CallResult ArmCall::step(int64_t utime) {
  if (begun_ < 0) begun_ = utime;
  if (utime - begun_ > kSettle && motor_.any() && motor_.age(utime) < kFreshAge && shown())
    return CallResult::kDone;
  if (utime - begun_ > patience_) return CallResult::kRefused;
  if (utime < next_) return CallResult::kGoesOn;
  next_ = utime + kRepeat;
  arm_t message{};
  message.utime = utime;
  message.seq = seq_++;
  message.armed = arm_;
  message.armed_by = asker_.by;
  message.arm_reason = asker_.why;
  bus_.publish(kArm, message);
  return CallResult::kGoesOn;
}

std::string ArmCall::words(int64_t utime) const {
  const bool done = motor_.any() && motor_.age(utime) < kFreshAge && shown();
  if (done) return arm_ ? "armed" : "disarmed";
  return std::string(arm_ ? "not armed; " : "not disarmed; ") + stateWords(motor_, utime);
}

StopCall::StopCall(Bus& bus, Asker asker, bool engage, double patience)
    : bus_(bus),
      asker_(std::move(asker)),
      engage_(engage),
      patience_(micro(patience)),
      motor_(bus, kMotor) {}

bool StopCall::shown() const {
  return (motor_.message().bridge_state == motor_t::STATE_ESTOP) == engage_;
}

CallResult StopCall::step(int64_t utime) {
  if (begun_ < 0) begun_ = utime;
  if (utime - begun_ > kSettle && motor_.any() && motor_.age(utime) < kFreshAge && shown())
    return CallResult::kDone;
  if (utime - begun_ > patience_) return CallResult::kRefused;
  if (utime < next_) return CallResult::kGoesOn;
  next_ = utime + kRepeat / 2;
  estop_t message{};
  message.utime = utime;
  message.seq = seq_++;
  message.engaged = engage_;
  message.estop_by = asker_.by;
  message.estop_reason = asker_.why;
  bus_.publish(kEstop, message);
  return CallResult::kGoesOn;
}

std::string StopCall::words(int64_t utime) const {
  const bool done = motor_.any() && motor_.age(utime) < kFreshAge && shown();
  if (done)
    return engage_ ? "stopped; tread-stop --clear, then tread-arm, to go on"
                   : "emergency stop cleared; tread-arm to go on";
  return std::string(engage_ ? "NOBODY CONFIRMS THE STOP; " : "not cleared; ") +
         stateWords(motor_, utime);
}

}  // namespace tread::operators
