// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/bench/faults/fault_schedule.hpp"

#include <algorithm>
#include <random>

#include "common/report/text.hpp"
#include "tools/missions/robot_system.hpp"

namespace tread::faults {
namespace {

const char* nameOf(FaultKind kind) {
  constexpr const char* kNames[] = {"drop",
                                    "delay",
                                    "duplicate",
                                    "reorder",
                                    "corrupt",
                                    "forge",
                                    "replay",
                                    "kill",
                                    "hang",
                                    "INS outage",
                                    "INS garbage",
                                    "INS jump",
                                    "INS freeze",
                                    "INS drift",
                                    "phantom obstacle",
                                    "vanishing obstacles",
                                    "battery sag",
                                    "motor line",
                                    "wrong pattern set",
                                    "operator lost",
                                    "E-stop",
                                    "disarmed"};
  static_assert(std::size(kNames) == static_cast<size_t>(FaultKind::kCount));
  return kNames[static_cast<size_t>(kind)];
}

/// Draws in the same way on every machine.
class Draw {
 public:
  explicit Draw(uint64_t seed) : engine_(seed * 0x9e3779b97f4a7c15ULL + 77) {}
  uint64_t below(uint64_t count) { return engine_() % count; }
  double share() { return static_cast<double>(engine_() >> 11) * 0x1.0p-53; }
  template <class List>
  const auto& oneOf(const List& list) {
    return list[below(std::size(list))];
  }

 private:
  std::mt19937_64 engine_;
};

const std::vector<std::string> kForged{"ARM",   "GOAL", "PROGRAM", "PATTERN_SET",
                                       "ESTOP", "MAP",  "INS",     "OPERATOR"};
const std::vector<std::string> kDisturbed{"*",        "INS",         "SCAN",  "MAP",
                                          "PROGRAM",  "MOTOR",       "ARM",   "GOAL",
                                          "OPERATOR", "PATTERN_SET", "ESTOP", "EXECUTION"};

}  // namespace

int64_t FaultSchedule::end() const {
  int64_t end = 0;
  for (const Fault& fault : faults) end = std::max(end, fault.until);
  return end;
}

FaultSchedule drawSchedule(uint64_t seed, int64_t first, int64_t last) {
  Draw draw(seed);
  FaultSchedule schedule;
  schedule.seed = seed;
  schedule.keyed = draw.below(2) == 1;
  const uint64_t count = 1 + draw.below(4);
  for (uint64_t i = 0; i < count; ++i) {
    Fault fault;
    fault.kind = static_cast<FaultKind>(draw.below(static_cast<uint64_t>(FaultKind::kCount)));
    const auto span = static_cast<double>(last - first);
    fault.from = first + static_cast<int64_t>(span * draw.share());
    fault.until = fault.from + 50'000 + static_cast<int64_t>(3e6 * draw.share() * draw.share());
    const bool forged = fault.kind == FaultKind::kForge || fault.kind == FaultKind::kReplay;
    fault.channel = forged ? draw.oneOf(kForged) : draw.oneOf(kDisturbed);
    const bool any = draw.below(2) == 0 && fault.kind <= FaultKind::kCorrupt;
    fault.node = any ? "*" : draw.oneOf(missions::robotNodes());
    fault.strength = draw.share();
    schedule.faults.push_back(fault);
  }
  return schedule;
}

FaultPlan planOf(const FaultSchedule& schedule) {
  FaultPlan plan;
  for (const Fault& fault : schedule.faults) {
    MessageFault message;
    message.channel = fault.channel;
    message.receiver = fault.node;
    message.from = fault.from;
    message.until = fault.until;
    const double share = 0.05 + 0.95 * fault.strength;
    switch (fault.kind) {
      case FaultKind::kDrop:
        message.drop = share;
        break;
      case FaultKind::kDelay:
        message.delay_us = static_cast<int64_t>(1.2e6 * fault.strength * fault.strength);
        break;
      case FaultKind::kDuplicate:
        message.duplicate = share;
        break;
      case FaultKind::kReorder:
        message.reorder = share;
        message.reorder_us = 20'000 + static_cast<int64_t>(4e5 * fault.strength);
        break;
      case FaultKind::kCorrupt:
        message.corrupt = share;
        break;
      default:
        continue;
    }
    plan.messages.push_back(message);
  }
  return plan;
}

std::string describe(const Fault& fault) {
  std::string words = formatted("%.2f to %.2f s: %s", static_cast<double>(fault.from) * 1e-6,
                                static_cast<double>(fault.until) * 1e-6, nameOf(fault.kind));
  if (fault.kind <= FaultKind::kReplay) words += " on " + fault.channel;
  if (fault.kind <= FaultKind::kCorrupt) words += " to " + fault.node;
  if (fault.kind == FaultKind::kKill || fault.kind == FaultKind::kHang)
    words += " of " + fault.node;
  return words + formatted(", strength %.2f", fault.strength);
}

}  // namespace tread::faults
