// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/core/program.hpp"

#include <algorithm>
#include <cmath>

namespace tread::motor {
namespace {

/// Commands travel as 32-bit floats: 1.0 must not fail for its last bit.
constexpr double kRangeTolerance = 1e-6;

SlotFault checkSeries(const std::vector<Command>& series, const CommandChannels& channels) {
  SlotFault fault = SlotFault::kNone;
  for (const Command& command : series) {
    for (size_t i = 0; i < Command::kMaxChannels; ++i) {
      if (!std::isfinite(command[i])) return SlotFault::kNotFinite;
      const double lowest = i < channels.size() ? channels[i].lowest : 0.0;
      const double highest = i < channels.size() ? channels[i].highest : 0.0;
      if (command[i] < lowest - kRangeTolerance || command[i] > highest + kRangeTolerance)
        fault = SlotFault::kOutOfRange;
    }
  }
  return fault;
}

}  // namespace

bool sameOrder(const ProgramSlot& a, const ProgramSlot& b) {
  return a.execution_id == b.execution_id && a.pattern_id == b.pattern_id &&
         a.set_version == b.set_version && a.kinds == b.kinds && a.period_us == b.period_us &&
         a.series == b.series;
}

SlotFault checkSlot(const ProgramSlot& slot, const SlotLimits& limits) {
  if (slot.empty()) return SlotFault::kNone;
  if (slot.execution_id < 0) return SlotFault::kBadId;
  if (slot.kinds.empty() || slot.kinds != kindsOf(limits.channels)) return SlotFault::kUnknownKind;
  if (slot.period_us <= 0 || slot.period_us > limits.max_period_us ||
      slot.period_us % limits.step_us != 0) {
    return SlotFault::kBadPeriod;
  }
  if (slot.series.empty()) return SlotFault::kNoCommands;
  if (slot.durationUs() > limits.max_duration_us) return SlotFault::kTooLong;
  return checkSeries(slot.series, limits.channels);
}

const char* describe(SlotFault fault) {
  switch (fault) {
    case SlotFault::kNone:
      return "good";
    case SlotFault::kBadId:
      return "a negative execution id";
    case SlotFault::kUnknownKind:
      return "a command kind the controller is not set up for";
    case SlotFault::kBadPeriod:
      return "a period that is zero, too long or not a multiple of the bridge's step";
    case SlotFault::kNoCommands:
      return "an execution without commands";
    case SlotFault::kTooLong:
      return "a series longer than allowed";
    case SlotFault::kNotFinite:
      return "a command that is NaN or infinite";
    case SlotFault::kOutOfRange:
      return "a command out of range";
  }
  return "an unknown fault";
}

const char* describe(ProgramRefusal refusal) {
  switch (refusal) {
    case ProgramRefusal::kNone:
      return "accepted";
    case ProgramRefusal::kFromFuture:
      return "its utime is in the future";
    case ProgramRefusal::kTooOld:
      return "older than the lease";
    case ProgramRefusal::kOutOfOrder:
      return "not newer than the one before";
    case ProgramRefusal::kBadLease:
      return "its lease is not positive";
    case ProgramRefusal::kRunChanged:
      return "the planner was restarted while armed";
    case ProgramRefusal::kBadSlot:
      return "a slot breaks its limits";
  }
  return "unknown";
}

ProgramRefusal ProgramGate::checkTime(const Program& program, int64_t now) const {
  if (program.lease_us <= 0) return ProgramRefusal::kBadLease;
  if (program.utime > now + limits_.max_future_us) return ProgramRefusal::kFromFuture;
  // The difference to an arbitrary utime could overflow: compare with a time near now.
  if (program.utime < now - std::min(program.lease_us, limits_.lease_us))
    return ProgramRefusal::kTooOld;
  return newer(program) ? ProgramRefusal::kNone : ProgramRefusal::kOutOfOrder;
}

bool ProgramGate::newer(const Program& program) const {
  if (!run_id_ || program.utime != newest_utime_) return !run_id_ || program.utime > newest_utime_;
  // The order of utimes also holds between runs, because all planners read this host's clock.
  return program.run_id != *run_id_ || program.seq > newest_seq_;
}

ProgramGate::Admission ProgramGate::admit(const Program& program, int64_t now, bool may_adopt_run) {
  Admission admission;
  admission.refusal = checkTime(program, now);
  if (admission.refusal == ProgramRefusal::kNone) {
    admission.new_run = !run_id_ || program.run_id != *run_id_;
    admission.refusal = run_id_ && admission.new_run && !may_adopt_run ? ProgramRefusal::kRunChanged
                                                                       : ProgramRefusal::kNone;
  }
  if (admission.refusal != ProgramRefusal::kNone) return admission;
  run_id_ = program.run_id;
  newest_utime_ = program.utime;
  newest_seq_ = program.seq;
  const SlotFault running = checkSlot(program.running, limits_.slot);
  admission.slot_fault =
      running != SlotFault::kNone ? running : checkSlot(program.next, limits_.slot);
  admission.refusal =
      admission.slot_fault == SlotFault::kNone ? ProgramRefusal::kNone : ProgramRefusal::kBadSlot;
  return admission;
}

void ProgramGate::renew(const Program& program, int64_t now) {
  renewed_at_ = now;
  renewed_utime_ = program.utime;
  lease_us_ = std::min(program.lease_us, limits_.lease_us);
}

std::optional<int64_t> ProgramGate::leaseAge(int64_t now) const {
  if (!renewed_at_) return std::nullopt;
  return std::max(now - *renewed_at_, now - renewed_utime_);
}

bool ProgramGate::leaseValid(int64_t now) const {
  const std::optional<int64_t> age = leaseAge(now);
  return age && *age <= lease_us_;
}

}  // namespace tread::motor
