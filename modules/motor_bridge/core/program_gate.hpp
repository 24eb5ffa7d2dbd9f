// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <optional>

#include "modules/motor_bridge/core/program.hpp"

namespace tread::motor {

/// Why a program was not let in.
enum class Refusal {
  kNone,
  kFromFuture,  ///< utime further ahead of the host clock than clocks may differ
  kTooOld,      ///< utime older than the lease
  kOutOfOrder,  ///< not newer than the last one: reordered or duplicated on the way
  kBadLease,    ///< lease not positive
  kRunChanged,  ///< from another run of the planner, while armed: a reason to stop
  kBadSlot,     ///< see SlotFault: a reason to stop
};

/// The refusal in words, e.g. "older than the lease".
const char* describe(Refusal refusal);

/// Limits on programs as they arrive.
struct GateLimits {
  int64_t lease_us = 200'000;      ///< upper limit of any lease [us]
  int64_t max_future_us = 50'000;  ///< clock difference allowed [us]
  SlotLimits slot;
};

/// Checks age, order, run and content of each program, and keeps the lease.
class ProgramGate {
 public:
  explicit ProgramGate(const GateLimits& limits) : limits_(limits) {}

  /// What the gate found.
  struct Verdict {
    Refusal refusal = Refusal::kNone;
    SlotFault slot_fault = SlotFault::kNone;
    bool new_run = false;  ///< let in as the first of another run
  };

  /// Checks a program received at now [us]; a new run is let in only if it may be adopted.
  Verdict admit(const Program& program, int64_t now, bool may_adopt_run);
  /// An admitted program counts as a sign of life from now on.
  void renew(const Program& program, int64_t now);
  /// True while the last renewal is younger than the lease, by receipt and by utime.
  bool leaseValid(int64_t now) const;
  /// Age of the lease [us]: the larger one of the ages by receipt and by utime; nothing if never
  /// renewed.
  std::optional<int64_t> leaseAge(int64_t now) const;

 private:
  Refusal checkTime(const Program& program, int64_t now) const;
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
