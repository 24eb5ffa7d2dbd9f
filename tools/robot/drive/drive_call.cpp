// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/drive/drive_call.hpp"

#include <cmath>
#include <utility>

#include "common/messages/blank.hpp"
#include "common/messages/pattern_messages.hpp"
#include "common/report/text.hpp"

namespace tread::drive {
namespace {

using operators::CallResult;

constexpr int64_t kPeriod = 20'000;      // [us] of MANUAL
constexpr int64_t kArmRepeat = 100'000;  // [us]
constexpr int64_t kArmPatience = 3'000'000;
constexpr int64_t kGiveBack = 300'000;  // [us] for which the request is repeated
constexpr int64_t kSilent = 500'000;    // [us] MOTOR older than this shows nothing
constexpr int kRepeat = 3;              // repetitions of a message that must not be lost

bool sameShare(double a, double b) {
  return a == b || (std::isnan(a) && std::isnan(b));
}

bool sameWishes(const Wishes& a, const Wishes& b) {
  return sameShare(a.forward, b.forward) && sameShare(a.turn, b.turn) && a.hold == b.hold &&
         a.give_back == b.give_back;
}

const char* stateWord(int16_t state) {
  switch (state) {
    case motor_t::STATE_ARMED:
      return "armed";
    case motor_t::STATE_DRIVING:
      return "drives by itself";
    case motor_t::STATE_STOPPING:
      return "stopping";
    case motor_t::STATE_FAULT:
      return "FAULT";
    case motor_t::STATE_ESTOP:
      return "E-STOP";
    case motor_t::STATE_MANUAL:
      return "BY HAND";
    default:
      return "disarmed";
  }
}

}  // namespace

DriveCall::DriveCall(Bus& bus, const operators::Requester& requester, std::unique_ptr<Stick> stick)
    : bus_(bus),
      requester_(requester),
      stick_(std::move(stick)),
      beacon_(bus, requester.operator_name),
      motor_(bus, kMotor) {}

bool DriveCall::armed() const {
  return motor_.any() && mayDrive(motor_.message().bridge_state);
}

CallResult DriveCall::step(int64_t utime) {
  beacon_.step(utime);
  const Wishes before = wishes_;
  try {
    wishes_ = stick_->read(utime);
  } catch (const std::exception& error) {
    gone_ = error.what();
    return CallResult::kRefused;
  }
  if (wishes_.ended) return CallResult::kDone;
  if (wishes_.arm && !before.arm) arms_until_ = utime + kArmPatience;
  if (wishes_.give_back) gives_back_until_ = utime + kGiveBack;
  if (!beacon_.hearsRobot()) return CallResult::kPending;
  serveButtons(utime);
  tell(utime);
  return CallResult::kPending;
}

void DriveCall::serveButtons(int64_t utime) {
  // A robot that was armed may have been stopped since: an old button press must not arm it again.
  const bool by_itself = armed() && motor_.message().bridge_state != motor_t::STATE_MANUAL;
  const bool disarms = wishes_.disarm || (wishes_.stop && by_itself);
  if (armed() || disarms || wishes_.stop) arms_until_ = 0;
  const bool asks = disarms || utime < arms_until_;
  if (!asks || utime < next_arm_) return;
  next_arm_ = utime + kArmRepeat;
  operators::sendArm(bus_, requester_, !disarms, beacon_.robotTime(utime), seq_arm_++);
}

void DriveCall::tell(int64_t utime) {
  Wishes wishes = wishes_;
  wishes.give_back = utime < gives_back_until_;
  if (utime < next_ && sameWishes(wishes, told_)) return;
  sendManual(utime, wishes);
}

void DriveCall::sendManual(int64_t utime, const Wishes& wishes) {
  const TrackCommand share = mixed(wishes.forward, wishes.turn);
  auto message = blank<manual_t>();
  message.utime = beacon_.robotTime(utime);
  message.seq = seq_++;
  message.station = beacon_.station();
  message.operator_name = beacon_.name();
  message.seen_utime = beacon_.seenUtime();
  message.hold = wishes.hold;
  message.give_back = wishes.give_back;
  message.hand_left = static_cast<float>(share.left);
  message.hand_right = static_cast<float>(share.right);
  bus_.publish(kManual, message);
  told_ = wishes;
  next_ = utime + kPeriod;
}

std::string DriveCall::describe(int64_t utime) const {
  if (!gone_.empty()) return gone_ + "; the robot is let go";
  if (wishes_.ended) return "the recording is over; the robot is let go";
  if (!motor_.any()) return operators::kNoMotor + operators::keyWords(bus_);
  if (motor_.age(utime) > kSilent) return "MOTOR has fallen silent: look at tread-motor-bridge";
  const motor_t& motor = motor_.message();
  const bool car = motor.channel_kind[1] == static_cast<int16_t>(CommandKind::kSteeringAngle);
  std::string words = formatted("%-16s", stateWord(motor.bridge_state));
  if (motor.channel_kind[2] != 0) {
    words += "  wheels";
    for (size_t i = 0; i < Command::kMaxChannels && motor.channel_kind[i] != 0; ++i)
      words += formatted(" %+.2f", motor.command[i]);
  } else {
    words += formatted(car ? "  throttle %+.2f steering %+.2f" : "  left %+.2f right %+.2f",
                       motor.command[0], motor.command[1]);
  }
  if (std::isfinite(motor.battery_voltage)) words += formatted("  %.1f V", motor.battery_voltage);
  words += wishes_.hold ? "  held" : "  not held";
  if (std::isnan(wishes_.forward) || std::isnan(wishes_.turn))
    words += "  stick not yet seen at rest: move it in all directions once and let it go";
  return words + "  " + motor.state_reason + operators::keyWords(bus_);
}

void DriveCall::letGo(int64_t utime) {
  if (!beacon_.hearsRobot()) return;
  const bool in_hand = motor_.any() && motor_.message().bridge_state == motor_t::STATE_MANUAL;
  for (int i = 0; i < kRepeat; ++i) {
    sendManual(utime, Wishes{});
    if (in_hand || arms_until_ > utime)
      operators::sendArm(bus_, requester_, false, beacon_.robotTime(utime), seq_arm_++);
  }
  beacon_.letGo(utime);
}

}  // namespace tread::drive
