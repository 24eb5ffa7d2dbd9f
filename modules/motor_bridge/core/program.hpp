// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <vector>

#include "common/pattern/pattern.hpp"

namespace tread::motor {

/// No command: the kind of an empty slot.
inline constexpr CommandKind kNoCommand{};

/// True for the command that stops both tracks.
inline bool isZero(const TrackCommand& command) {
  return command == TrackCommand{};
}

/// One pattern execution as ordered: a command series played at a fixed period.
struct Slot {
  int64_t execution_id = 0;  ///< counts up within a run; 0 = empty slot
  int32_t pattern_id = 0;
  int64_t set_version = 0;
  CommandKind kind = kNoCommand;
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
