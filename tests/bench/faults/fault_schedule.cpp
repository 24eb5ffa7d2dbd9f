// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/bench/faults/fault_schedule.hpp"

#include <algorithm>

#include "common/config/scalars.hpp"
#include "common/report/text.hpp"
#include "tools/lab/missions/robot_system.hpp"

namespace tread::faults {

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
                                    "disarmed",
                                    "INS tilt",
                                    "range finder frozen",
                                    "old scans under new times",
                                    "scans mirrored",
                                    "scans turned",
                                    "scans all far",
                                    "scans all zero",
                                    "INS mirrored",
                                    "motors swapped"};
  static_assert(std::size(kNames) == static_cast<size_t>(FaultKind::kCount));
  return kNames[static_cast<size_t>(kind)];
}

namespace {

/// Kinds that drawSchedule() draws from: more would change the meaning of old seeds.
constexpr auto kFirstKinds = static_cast<uint64_t>(FaultKind::kTilt);
constexpr uint64_t kScenarioStream = 0x5ce9a210;
constexpr uint64_t kScanStream = 0x11e5ca9;
constexpr uint64_t kPlannerStream = 0x91a77e2;
constexpr uint64_t kLieStream = 0x71e5;

const std::vector<std::string> kForged{"ARM",   "GOAL", "PROGRAM", "PATTERN_SET",
                                       "ESTOP", "MAP",  "INS",     "OPERATOR"};
const std::vector<std::string> kDisturbed{"*",        "INS",         "SCAN",  "MAP",
                                          "PROGRAM",  "MOTOR",       "ARM",   "GOAL",
                                          "OPERATOR", "PATTERN_SET", "ESTOP", "EXECUTION"};
const std::vector<std::string> kLater{"MANUAL", "FENCE", "STOPPING"};
const std::vector<std::string> kLaterReceivers{"motor_bridge", "planner", "*"};

}  // namespace

int64_t FaultSchedule::end() const {
  int64_t end = 0;
  for (const Fault& fault : faults) end = std::max(end, fault.until);
  return end;
}

bool FaultSchedule::onlyLies() const {
  const bool believed = std::none_of(faults.begin(), faults.end(), [](const Fault& fault) {
    const bool invents = fault.kind == FaultKind::kCorrupt || fault.kind == FaultKind::kForge;
    return invents && (fault.channel == "MANUAL" || fault.channel == "*");
  });
  return scenario.lie && !scenario.hand && believed;
}

FaultSchedule drawSchedule(uint64_t seed, int64_t first, int64_t last) {
  Draw draw(seed);
  FaultSchedule schedule;
  schedule.seed = seed;
  schedule.keyed = draw.below(2) == 1;
  const uint64_t count = 1 + draw.below(4);
  for (uint64_t i = 0; i < count; ++i) {
    Fault fault;
    fault.kind = static_cast<FaultKind>(draw.below(kFirstKinds));
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

namespace {

double between(Draw& draw, double low, double high) {
  return low + (high - low) * draw.share();
}

/// A time from `first` on, drawn from the first share of the interval.
int64_t moment(Draw& draw, int64_t first, int64_t last, double share) {
  return first + static_cast<int64_t>(share * draw.share() * static_cast<double>(last - first));
}

std::vector<Fence> drawFences(Draw& draw) {
  const double west = -between(draw, 1.2, 4.0), east = between(draw, 21.0, 26.0);
  const double south = -between(draw, 3.0, 9.0), north = between(draw, 3.0, 9.0);
  std::vector<Fence> fences{
      {"yard", false, {{west, south}, {east, south}, {east, north}, {west, north}}}};
  if (draw.below(2) == 0) return fences;
  const double x = between(draw, 2.2, 7.0), y = between(draw, -1.5, 1.5);
  const double size = between(draw, 0.2, 1.5);
  fences.push_back({"pond", true, {{x, y - size}, {x + size, y}, {x, y + size}}});
  return fences;
}

HandStretch drawHand(Draw& draw, int64_t first, int64_t last) {
  HandStretch hand;
  hand.from = moment(draw, first + 1'500'000, last, 0.6);
  hand.until = hand.from + 1'000'000 + static_cast<int64_t>(4e6 * draw.share());
  hand.released = draw.share();
  hand.forward = draw.below(4) == 0 ? -0.6 : between(draw, 0.3, 1.0);
  if (draw.below(2) == 0) return hand;
  hand.silent_from = moment(draw, hand.from, hand.until, 1.0);
  hand.silent_until = hand.silent_from + moment(draw, 100'000, 4'000'000, 1.0);
  return hand;
}

HandLie drawLie(Draw& draw, int64_t first, int64_t last) {
  HandLie lie;
  lie.kind = static_cast<HandLie::Kind>(draw.below(3));
  lie.seed = draw.below(1'000'000'000);
  lie.from = moment(draw, 0, last, 0.5);
  lie.until = lie.from + 3'000'000 + moment(draw, first, last, 1.0);
  lie.silent_from = moment(draw, lie.from, lie.until, 1.0);
  lie.silent_until = lie.silent_from + moment(draw, 0, 1'500'000, 1.0);
  return lie;
}

Fault drawLater(Draw& draw, int64_t first, int64_t last) {
  Fault fault;
  const uint64_t kind = draw.below(10);
  const bool tilt = kind > static_cast<uint64_t>(FaultKind::kReplay);
  fault.kind = tilt ? FaultKind::kTilt : static_cast<FaultKind>(kind);
  fault.from = moment(draw, first, last, 1.0);
  fault.until = fault.from + 50'000 + static_cast<int64_t>(3e6 * draw.share());
  fault.channel = draw.oneOf(kLater);
  fault.node = draw.oneOf(kLaterReceivers);
  fault.strength = draw.share();
  return fault;
}

}  // namespace

void addLie(FaultSchedule& schedule, int64_t first, int64_t last) {
  Draw draw(schedule.seed ^ kLieStream);
  schedule.scenario.hand.reset();
  schedule.scenario.lie = drawLie(draw, first, last);
}

void addScenario(FaultSchedule& schedule, int64_t first, int64_t last) {
  Draw draw(schedule.seed ^ kScenarioStream);
  Scenario& scenario = schedule.scenario;
  if (draw.share() < 0.35) scenario.own_fences = drawFences(draw);
  scenario.planner_knows = Draw(schedule.seed ^ kPlannerStream).share() < 0.6;
  if (draw.share() < 0.25) {
    scenario.fence_at = moment(draw, first + 1'500'000, last, 1.0);
    scenario.fence_ahead = between(draw, 1.3, 4.0);
    scenario.fence_width = between(draw, 0.5, 4.0);
  }
  if (draw.share() < 0.35) scenario.hand = drawHand(draw, first, last);
  if (!scenario.hand && Draw(~schedule.seed ^ kLieStream).below(3) == 0)
    addLie(schedule, first, last);
  if (draw.share() < 0.5) schedule.faults.push_back(drawLater(draw, first, last));
  scenario.go_back = draw.share() < 0.25;
  if (!scenario.go_back) return;
  // Long enough for a return, or for good.
  const int64_t from = moment(draw, first + 2'500'000, last, 0.6);
  const int64_t until = from + 3'500'000 + static_cast<int64_t>(10e6 * draw.share());
  schedule.faults.push_back({FaultKind::kOperatorLost, from, until, "*", "*", 1.0});
  const uint64_t stop = draw.below(4);
  const int64_t stop_from = from + 3'500'000 + static_cast<int64_t>(3e6 * draw.share());
  if (stop < 2)
    schedule.faults.push_back({stop == 0 ? FaultKind::kEstop : FaultKind::kDisarm, stop_from,
                               stop_from + 300'000, "*", "*", 1.0});
}

FaultSchedule drawScanFault(uint64_t seed, int64_t first, int64_t last) {
  Draw draw(seed ^ kScanStream);
  constexpr auto kFirst = static_cast<uint64_t>(FaultKind::kScanFreeze);
  constexpr auto kEnd = static_cast<uint64_t>(FaultKind::kScanZero) + 1;
  Fault fault;
  fault.kind = static_cast<FaultKind>(kFirst + draw.below(kEnd - kFirst));
  fault.from = moment(draw, first, last, 1.0);
  const bool for_good = draw.share() < 0.7;
  fault.until = for_good ? INT64_MAX : fault.from + static_cast<int64_t>(5e6 * draw.share());
  fault.strength = draw.share();
  FaultSchedule schedule;
  schedule.seed = seed;
  schedule.faults.push_back(fault);
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

std::string describe(const Scenario& scenario) {
  std::vector<std::string> words;
  if (!scenario.own_fences.empty())
    words.emplace_back(scenario.planner_knows ? "fences in the file"
                                              : "fences that only the bridge knows");
  if (scenario.fence_at)
    words.push_back(formatted("the operator's fence at %.2f s, %.1f m ahead, %.1f m wide",
                              static_cast<double>(*scenario.fence_at) * 1e-6, scenario.fence_ahead,
                              scenario.fence_width));
  if (const auto& hand = scenario.hand)
    words.push_back(formatted("by hand from %.2f to %.2f s, halted from %.2f to %.2f s",
                              static_cast<double>(hand->from) * 1e-6,
                              static_cast<double>(hand->until) * 1e-6,
                              static_cast<double>(hand->silent_from) * 1e-6,
                              static_cast<double>(hand->silent_until) * 1e-6));
  constexpr const char* kLiars[] = {"pad", "keyboard", "page"};
  if (const auto& lie = scenario.lie)
    words.push_back(formatted(
        "a %s that lies from %.2f to %.2f s, halted from %.2f to %.2f s",
        kLiars[static_cast<size_t>(lie->kind)], static_cast<double>(lie->from) * 1e-6,
        static_cast<double>(lie->until) * 1e-6, static_cast<double>(lie->silent_from) * 1e-6,
        static_cast<double>(lie->silent_until) * 1e-6));
  if (scenario.go_back) words.emplace_back("lost: go_back");
  return joinWords(words);
}

}  // namespace tread::faults
