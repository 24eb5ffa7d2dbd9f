// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <vector>

namespace tread::motor {

/// What a command means; the numbers are those of program_slot_t.
enum class CommandKind : int16_t {
  kNone = 0,
  kPower = 1,       ///< share of full motor power, -1..1 [1]
  kTrackSpeed = 2,  ///< track speed [m/s]
};

/// One command for both tracks, in the units of its CommandKind; + forward.
struct TrackCommand {
  double left = 0.0;
  double right = 0.0;

  bool zero() const { return left == 0.0 && right == 0.0; }
  bool operator==(const TrackCommand& other) const {
    return left == other.left && right == other.right;
  }
  bool operator!=(const TrackCommand& other) const { return !(*this == other); }
};

/// One pattern execution as ordered: a command series played at a fixed period.
struct Slot {
  int64_t execution_id = 0;  ///< counts up within a run; 0 = empty slot
  int32_t pattern_id = 0;
  int64_t set_version = 0;
  CommandKind kind = CommandKind::kNone;
  int64_t period_us = 0;             ///< each command is held this long [us]
  std::vector<TrackCommand> series;  ///< u_1 .. u_T

  bool empty() const { return execution_id == 0; }
  int64_t durationUs() const { return period_us * static_cast<int64_t>(series.size()); }
};

/// True if both order the same commands for the same execution.
bool sameOrder(const Slot& a, const Slot& b);

/// What the planner wants of the motors: complete state, sent at 20 Hz.
struct Program {
  int64_t utime = 0;  ///< [us] when it was sent
  int64_t seq = 0;
  int64_t run_id = 0;    ///< one per start of the planner: its boot utime
  int64_t lease_us = 0;  ///< valid for this long [us]
  Slot running;
  Slot next;
};

/// What a slot must keep to.
struct SlotLimits {
  CommandKind kind = CommandKind::kPower;  ///< what the controller is set up for
  double max_command = 1.0;                ///< largest magnitude, in the units of the kind
  int64_t step_us = 10'000;                ///< a period must be a multiple of this [us]
  int64_t max_period_us = 200'000;         ///< [us]
  int64_t max_duration_us = 60'000'000;    ///< of one series [us]
};

/// What is wrong with a slot. Everything but kNone stops a moving robot.
enum class SlotFault {
  kNone,
  kBadId,        ///< negative execution id
  kUnknownKind,  ///< not what the controller is set up for
  kBadPeriod,    ///< zero, too long, or not a multiple of the bridge's step
  kNoCommands,
  kTooLong,
  kNotFinite,
  kOutOfRange,
};

/// First fault found in a slot; an empty slot has none.
SlotFault checkSlot(const Slot& slot, const SlotLimits& limits);

/// The fault in words, e.g. "a command is NaN or infinite".
const char* describe(SlotFault fault);

}  // namespace tread::motor
