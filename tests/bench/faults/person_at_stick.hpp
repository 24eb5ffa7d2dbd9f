// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <memory>

#include "tests/bench/faults/fault_schedule.hpp"
#include "tools/robot/drive/drive_call.hpp"

namespace tread::faults {

/// tread-drive with a person at its stick, for one stretch of a mission: takes the robot, steers,
/// lets the button go for a moment, and gives the robot back; or falls silent, and comes back.
class PersonAtStick {
 public:
  PersonAtStick(Bus& bus, const HandStretch& stretch);

  /// Call every 20 ms or so; `since` the start of the mission [us].
  void step(int64_t now, int64_t since);

 private:
  HandStretch stretch_;
  std::unique_ptr<drive::DriveCall> call_;
};

}  // namespace tread::faults
