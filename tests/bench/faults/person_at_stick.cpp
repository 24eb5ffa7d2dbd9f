// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/bench/faults/person_at_stick.hpp"

#include <cmath>

namespace tread::faults {
namespace {

constexpr int64_t kRests = 200'000;      // [us] with the button held and the stick at rest
constexpr int64_t kGivesBack = 500'000;  // [us]

class ScriptedStick : public drive::Stick {
 public:
  /// `begin` [us] on the bus's clock.
  ScriptedStick(const HandStretch& stretch, int64_t begin) : stretch_(stretch), begin_(begin) {}

  drive::Wishes read(int64_t now) override {
    const int64_t since = now - begin_, length = stretch_.until - stretch_.from;
    drive::Wishes wishes;
    wishes.forward = wishes.turn = 0.0;
    wishes.give_back = since >= length;
    if (since >= length) return wishes;
    const auto share = static_cast<double>(since) / static_cast<double>(length);
    wishes.hold = share < stretch_.released || share > stretch_.released + 0.2;
    if (since < kRests) return wishes;
    wishes.forward = stretch_.forward;
    wishes.turn = 0.7 * std::sin(4.0 * share + 3.0 * stretch_.released);
    return wishes;
  }
  std::string name() const override { return "script"; }
  std::string keys() const override { return ""; }

 private:
  HandStretch stretch_;
  int64_t begin_;
};

}  // namespace

PersonAtStick::PersonAtStick(Bus& bus, const HandStretch& stretch) : stretch_(stretch) {
  const operators::Requester requester{"mission operator", "", "mission operator"};
  // It subscribes to MOTOR at once: the bus cannot add it later.
  call_ = std::make_unique<drive::DriveCall>(
      bus, requester, std::make_unique<ScriptedStick>(stretch, bus.now() + stretch.from));
}

void PersonAtStick::step(int64_t now, int64_t since) {
  const bool silent = since >= stretch_.silent_from && since < stretch_.silent_until;
  if (since < stretch_.from || since > stretch_.until + kGivesBack || silent) return;
  call_->step(now);
}

}  // namespace tread::faults
