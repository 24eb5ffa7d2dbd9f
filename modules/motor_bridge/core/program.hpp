// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>
#include <vector>

#include "common/pattern/pattern.hpp"

namespace tread::motor {

/// True for the command that stops the vehicle.
inline bool isZero(const Command& command) {
  return command == Command{};
}

/// One pattern execution as ordered: a command series played at a fixed period.
struct ProgramSlot {
  int64_t execution_id = 0;  ///< increases within a run; 0 = empty slot
  int32_t pattern_id = 0;
  int64_t set_version = 0;
  std::vector<CommandKind> kinds;  ///< of the channels of its commands
  int64_t period_us = 0;           ///< each command is held this long [us]
  std::vector<Command> series;     ///< u_1 .. u_T

  bool empty() const { return execution_id == 0; }
  int64_t durationUs() const { return period_us * static_cast<int64_t>(series.size()); }
};

/// Whether both order the same commands for the same execution.
bool sameOrder(const ProgramSlot& a, const ProgramSlot& b);

/// The planner's orders to the motors: complete state, sent at 20 Hz.
struct Program {
  int64_t utime = 0;  ///< [us] when it was sent
  int64_t seq = 0;
  int64_t run_id = 0;    ///< one per start of the planner: its boot utime
  int64_t lease_us = 0;  ///< valid for this long [us]
  ProgramSlot running;
  ProgramSlot next;
};

/// Limits of a slot.
struct SlotLimits {
  CommandChannels channels = trackChannels(CommandKind::kPower);  ///< accepted by the controller
  int64_t step_us = 10'000;              ///< a period must be a multiple of this [us]
  int64_t max_period_us = 200'000;       ///< [us]
  int64_t max_duration_us = 60'000'000;  ///< of one series [us]
};

/// Faults of a slot. All except kNone stop a moving robot.
enum class SlotFault {
  kNone,
  kBadId,        ///< negative execution id
  kUnknownKind,  ///< not the kind that the controller is configured for
  kBadPeriod,    ///< zero, too long, or not a multiple of the bridge's step
  kNoCommands,
  kTooLong,
  kNotFinite,
  kOutOfRange,
};

/// First fault found in a slot; an empty slot has none.
SlotFault checkSlot(const ProgramSlot& slot, const SlotLimits& limits);

/// The fault in words, e.g. "a command is NaN or infinite".
const char* describe(SlotFault fault);

/// Why a program was refused.
enum class ProgramRefusal {
  kNone,
  kFromFuture,  ///< utime is further ahead of the host clock than clocks may differ
  kTooOld,      ///< utime is older than the lease
  kOutOfOrder,  ///< not newer than the previous one: reordered or duplicated
  kBadLease,    ///< lease not positive
  kRunChanged,  ///< from another run of the planner, while armed: a reason to stop
  kBadSlot,     ///< see SlotFault: a reason to stop
};

/// The refusal in words, e.g. "older than the lease".
const char* describe(ProgramRefusal refusal);

/// Limits on incoming programs.
struct GateLimits {
  int64_t lease_us = 200'000;      ///< upper limit of any lease [us]
  int64_t max_future_us = 50'000;  ///< clock difference allowed [us]
  SlotLimits slot;
};

/// Checks age, order, run and content of each program, and maintains the lease.
class ProgramGate {
 public:
  explicit ProgramGate(const GateLimits& limits) : limits_(limits) {}

  /// Result of the gate.
  struct Admission {
    ProgramRefusal refusal = ProgramRefusal::kNone;
    SlotFault slot_fault = SlotFault::kNone;
    bool new_run = false;  ///< accepted as the first of another run
  };

  /// Checks a program received at now [us]; a new run is accepted only if it may be adopted.
  Admission admit(const Program& program, int64_t now, bool may_adopt_run);
  /// The admitted program renews the lease.
  void renew(const Program& program, int64_t now);
  /// Whether the last renewal is younger than the lease, by receipt and by utime.
  bool leaseValid(int64_t now) const;
  /// Age of the lease [us]: the larger of the ages by receipt and by utime; nullopt if never
  /// renewed.
  std::optional<int64_t> leaseAge(int64_t now) const;

 private:
  ProgramRefusal checkTime(const Program& program, int64_t now) const;
  bool newer(const Program& program) const;

  GateLimits limits_;
  std::optional<int64_t> run_id_;
  int64_t newest_utime_ = 0;
  int64_t newest_seq_ = 0;
  std::optional<int64_t> renewed_at_;
  int64_t renewed_utime_ = 0;
  int64_t lease_us_ = 0;
};

}  // namespace tread::motor
