// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <memory>

#include "tests/bench/faults/fault_schedule.hpp"
#include "tools/robot/drive/drive_call.hpp"

namespace tread::faults {

/// tread-drive with a pad or a keyboard whose stick never rests, or a foreign program that says so,
/// for one stretch of a mission: presses and releases the button, and falls silent in between.
class LyingHand {
 public:
  LyingHand(Bus& bus, const HandLie& lie);

  /// Call every 20 ms or so; `since` the start of the mission [us].
  void step(int64_t now, int64_t since);
  bool holds() const { return holds_; }

 private:
  HandLie lie_;
  std::unique_ptr<drive::DriveCall> call_;
  std::function<bool(int64_t)> page_;  ///< tells something at a time; whether the button is held
  bool holds_ = false;                 ///< the dead-man's button
};

}  // namespace tread::faults
