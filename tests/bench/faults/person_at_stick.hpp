// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <memory>

#include "tests/bench/faults/fault_schedule.hpp"
#include "tools/robot/drive/drive_call.hpp"

namespace tread::faults {

/// tread-drive with a person at its stick, for a period of a mission: takes over, steers, releases
/// the button for a moment, and gives back, or falls silent and returns.
class PersonAtStick {
 public:
  PersonAtStick(Bus& bus, const HandStretch& stretch);

  /// Call about every 20 ms; `since`: start of the mission [us].
  void step(int64_t now, int64_t since);

 private:
  HandStretch stretch_;
  std::unique_ptr<drive::DriveCall> call_;
};

}  // namespace tread::faults
