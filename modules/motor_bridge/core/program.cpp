// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/motor_bridge/core/program.hpp"

#include <algorithm>
#include <cmath>

namespace tread::motor {
namespace {

/// Commands travel as 32-bit floats: 1.0 must not fail for its last bit.
constexpr double kRangeTolerance = 1e-6;

SlotFault checkSeries(const std::vector<TrackCommand>& series, double max_command) {
  for (const TrackCommand& command : series) {
    if (!std::isfinite(command.left) || !std::isfinite(command.right)) {
      return SlotFault::kNotFinite;
    }
  }
  const double limit = max_command + kRangeTolerance;
  const bool in_range = std::all_of(series.begin(), series.end(), [limit](const TrackCommand& c) {
    return std::abs(c.left) <= limit && std::abs(c.right) <= limit;
  });
  return in_range ? SlotFault::kNone : SlotFault::kOutOfRange;
}

}  // namespace

bool sameOrder(const Slot& a, const Slot& b) {
  return a.execution_id == b.execution_id && a.pattern_id == b.pattern_id &&
         a.set_version == b.set_version && a.kind == b.kind && a.period_us == b.period_us &&
         a.series == b.series;
}

SlotFault checkSlot(const Slot& slot, const SlotLimits& limits) {
  if (slot.empty()) {
    return SlotFault::kNone;
  }
  if (slot.execution_id < 0) {
    return SlotFault::kBadId;
  }
  if (slot.kind == kNoCommand || slot.kind != limits.kind) {
    return SlotFault::kUnknownKind;
  }
  if (slot.period_us <= 0 || slot.period_us > limits.max_period_us ||
      slot.period_us % limits.step_us != 0) {
    return SlotFault::kBadPeriod;
  }
  if (slot.series.empty()) {
    return SlotFault::kNoCommands;
  }
  if (slot.durationUs() > limits.max_duration_us) {
    return SlotFault::kTooLong;
  }
  return checkSeries(slot.series, limits.max_command);
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

}  // namespace tread::motor
