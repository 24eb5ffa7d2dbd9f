// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <memory>

#include "tests/bench/faults/fault_schedule.hpp"
#include "tools/robot/drive/drive_call.hpp"

namespace tread::faults {

/// tread-drive with a pad or keyboard whose stick never rests, or an equivalent foreign program,
/// for a period of a mission: it presses and releases the button and falls silent at times.
class LyingHand {
 public:
  LyingHand(Bus& bus, const HandLie& lie);

  /// Call about every 20 ms; `since`: start of the mission [us].
  void step(int64_t now, int64_t since);
  bool holds() const { return holds_; }

 private:
  HandLie lie_;
  std::unique_ptr<drive::DriveCall> call_;
  /// sends a message at a time; returns whether the button is held
  std::function<bool(int64_t)> page_;
  bool holds_ = false;  ///< the dead-man's button
};

}  // namespace tread::faults
