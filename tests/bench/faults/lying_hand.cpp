// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/bench/faults/lying_hand.hpp"

#include <cstdlib>
#include <limits>
#include <utility>

#include <linux/input-event-codes.h>

#include "common/messages/blank.hpp"
#include "tools/robot/drive/keyboard.hpp"
#include "tools/robot/drive/pad.hpp"

namespace tread::faults {
namespace {

/// A state that toggles after random times of 40 ms to 1 s.
class Toggle {
 public:
  bool at(int64_t now, Draw& draw) {
    if (now >= next_) {
      on_ = !on_;
      next_ = now + 40'000 + static_cast<int64_t>(1e6 * draw.share());
    }
    return on_;
  }

 private:
  bool on_ = false;
  int64_t next_ = 0;
};

/// A pad with an axis that is never measured, or never centred.
class LyingPad : public drive::Stick {
 public:
  LyingPad(uint64_t seed, bool& holds) : draw_(seed), holds_(holds) {
    for (Axis& axis : axes_) axis = {draw_.below(2) == 0 ? 0 : 255, Habit(draw_.below(4))};
    if (axes_[0].habit == Habit::kRests && axes_[1].habit == Habit::kRests)
      axes_[draw_.below(2)].habit = Habit::kShakes;
    for (int i = 0; i < 2; ++i) {
      pad_.setRange(kCodes[i], 0, 255);
      // The centre, too, is only the kernel's stored value.
      pad_.begin(EV_ABS, kCodes[i], draw_.below(4) == 0 ? 128 : axes_[i].end);
    }
  }

  drive::Wishes read(int64_t now) override {
    for (int i = 0; i < 2; ++i) move(kCodes[i], axes_[i]);
    pad_.take(EV_KEY, BTN_TR, holds_ = button_.at(now, draw_));
    pad_.take(EV_KEY, BTN_START, draw_.below(40) == 0);
    return pad_.wishes();
  }
  std::string name() const override { return "lying pad"; }
  std::string keys() const override { return ""; }

 private:
  enum class Habit { kSilent, kRepeats, kShakes, kRests };
  struct Axis {
    int end = 0;
    Habit habit = Habit::kSilent;
  };
  static constexpr int kCodes[] = {ABS_X, ABS_Y};

  void move(int code, const Axis& axis) {
    const int shake = static_cast<int>(draw_.below(20));
    if (axis.habit == Habit::kRepeats) pad_.take(EV_ABS, code, axis.end);
    if (axis.habit == Habit::kShakes) pad_.take(EV_ABS, code, std::abs(axis.end - shake));
    if (axis.habit == Habit::kRests) pad_.take(EV_ABS, code, 118 + shake);
  }

  Draw draw_;
  bool& holds_;
  Toggle button_;
  drive::PadState pad_;
  Axis axes_[2];
};

/// A key that has been stuck since before the program's start.
class StuckKey : public drive::Stick {
 public:
  StuckKey(uint64_t seed, bool& holds)
      : draw_(seed), key_("wWaSdQeE"[draw_.below(8)]), holds_(holds) {}

  drive::Wishes read(int64_t now) override {
    if (draw_.below(40) == 0) keys_.take("\n", now);  // arms
    keys_.take(std::string(1, key_), now);
    const drive::Wishes wishes = keys_.wishes(now);
    holds_ = wishes.hold;
    return wishes;
  }
  std::string name() const override { return "stuck key"; }
  std::string keys() const override { return ""; }

 private:
  Draw draw_;
  char key_;
  bool& holds_;
  drive::KeyState keys_;
};

/// A foreign page or program that never reports rest: at most one track, or none.
class LyingPage {
 public:
  LyingPage(Bus& bus, uint64_t seed) : bus_(bus), draw_(seed), motor_(bus, kMotor) {}

  bool step(int64_t now) {
    constexpr float kPlaces[] = {1.0F,
                                 -1.0F,
                                 0.06F,
                                 std::numeric_limits<float>::quiet_NaN(),
                                 std::numeric_limits<float>::infinity(),
                                 2.0F};
    auto message = blank<manual_t>();
    message.utime = message.seen_utime = motor_.any() ? motor_.message().utime : now;
    message.seq = seq_ += static_cast<int64_t>(draw_.below(3));
    // Two programs in alternation.
    message.station = 501 + (second_.at(now, draw_) ? 1 : 0);
    message.operator_name = "mission operator";
    message.hold = button_.at(now, draw_);
    message.hand_left = draw_.oneOf(kPlaces);
    message.hand_right = draw_.below(2) == 0 ? 0.0F : draw_.oneOf(kPlaces);
    if (draw_.below(2) == 0) std::swap(message.hand_left, message.hand_right);
    bus_.publish(kManual, message);
    return message.hold != 0;
  }

 private:
  Bus& bus_;
  Draw draw_;
  Latest<motor_t> motor_;
  Toggle second_;
  Toggle button_;
  int64_t seq_ = 0;
};

}  // namespace

LyingHand::LyingHand(Bus& bus, const HandLie& lie) : lie_(lie) {
  std::unique_ptr<drive::Stick> stick;
  if (lie.kind == HandLie::Kind::kPage)
    page_ = [page = std::make_shared<LyingPage>(bus, lie.seed)](int64_t now) {
      return page->step(now);
    };
  if (lie.kind == HandLie::Kind::kPad) stick = std::make_unique<LyingPad>(lie.seed, holds_);
  if (lie.kind == HandLie::Kind::kKeyboard) stick = std::make_unique<StuckKey>(lie.seed, holds_);
  const operators::Requester requester{"mission operator", "", "mission operator"};
  if (stick) call_ = std::make_unique<drive::DriveCall>(bus, requester, std::move(stick));
}

void LyingHand::step(int64_t now, int64_t since) {
  const bool silent = since >= lie_.silent_from && since < lie_.silent_until;
  if (since < lie_.from || since > lie_.until || silent) return;
  if (page_)
    holds_ = page_(now);
  else
    call_->step(now);
}

}  // namespace tread::faults
