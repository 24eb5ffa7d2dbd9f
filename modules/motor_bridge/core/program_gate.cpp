// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/core/program_gate.hpp"

#include <algorithm>

namespace tread::motor {

const char* describe(Refusal refusal) {
  switch (refusal) {
    case Refusal::kNone:
      return "accepted";
    case Refusal::kFromFuture:
      return "its utime lies in the future";
    case Refusal::kTooOld:
      return "older than the lease";
    case Refusal::kOutOfOrder:
      return "not newer than the one before";
    case Refusal::kBadLease:
      return "its lease is not positive";
    case Refusal::kRunChanged:
      return "the planner was restarted while armed";
    case Refusal::kBadSlot:
      return "a slot breaks its limits";
  }
  return "unknown";
}

Refusal ProgramGate::checkTime(const Program& program, int64_t now) const {
  if (program.lease_us <= 0) {
    return Refusal::kBadLease;
  }
  if (program.utime > now + limits_.max_future_us) {
    return Refusal::kFromFuture;
  }
  // The difference to any utime would overflow: compare with a time near now.
  if (program.utime < now - std::min(program.lease_us, limits_.lease_us)) {
    return Refusal::kTooOld;
  }
  return newer(program) ? Refusal::kNone : Refusal::kOutOfOrder;
}

bool ProgramGate::newer(const Program& program) const {
  if (!run_id_ || program.utime != newest_utime_) {
    return !run_id_ || program.utime > newest_utime_;
  }
  // The order of utimes also holds between runs: all planners read the clock of this host.
  return program.run_id != *run_id_ || program.seq > newest_seq_;
}

ProgramGate::Verdict ProgramGate::admit(const Program& program, int64_t now, bool may_adopt_run) {
  Verdict verdict;
  verdict.refusal = checkTime(program, now);
  if (verdict.refusal == Refusal::kNone) {
    verdict.new_run = !run_id_ || program.run_id != *run_id_;
    verdict.refusal =
        run_id_ && verdict.new_run && !may_adopt_run ? Refusal::kRunChanged : Refusal::kNone;
  }
  if (verdict.refusal != Refusal::kNone) {
    return verdict;
  }
  run_id_ = program.run_id;
  newest_utime_ = program.utime;
  newest_seq_ = program.seq;
  const SlotFault running = checkSlot(program.running, limits_.slot);
  verdict.slot_fault =
      running != SlotFault::kNone ? running : checkSlot(program.next, limits_.slot);
  verdict.refusal = verdict.slot_fault == SlotFault::kNone ? Refusal::kNone : Refusal::kBadSlot;
  return verdict;
}

void ProgramGate::renew(const Program& program, int64_t now) {
  renewed_at_ = now;
  renewed_utime_ = program.utime;
  lease_us_ = std::min(program.lease_us, limits_.lease_us);
}

std::optional<int64_t> ProgramGate::leaseAge(int64_t now) const {
  if (!renewed_at_) {
    return std::nullopt;
  }
  return std::max(now - *renewed_at_, now - renewed_utime_);
}

bool ProgramGate::leaseValid(int64_t now) const {
  const std::optional<int64_t> age = leaseAge(now);
  return age && *age <= lease_us_;
}

}  // namespace tread::motor
