// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/study/hide/bad_log.hpp"

#include <algorithm>
#include <sstream>
#include <stdexcept>

#include "modules/simulator/core/noise.hpp"
#include "tests/study/hide/event_edit.hpp"
#include "tests/study/hide/rng.hpp"

namespace tread::blind {
namespace {

std::string at(const char* what, int64_t utime) {
  std::ostringstream text;
  text << what << " utime " << utime;
  return text.str();
}

/// A jump of the machine's clock: all later stamps are shifted, in either direction.
Defect jumpClock(Rng& rng, int64_t when, std::vector<LogEvent>& events) {
  const int64_t jump = static_cast<int64_t>(rng.sign()) * 7'000'000;
  const auto shift = [&](auto& message) {
    if (message.utime >= when) message.utime += jump;
  };
  editEach(events, kIns, shift);
  editEach(events, kMotor, shift);
  editEach(events, kMark, shift);
  editEach(events, kConfig, shift);
  editEach(events, kExecution, [&](execution_t& message) {
    shift(message);
    for (execution_record_t& record : message.records) {
      if (record.started >= when) record.started += jump;
      if (record.ended >= when) record.ended += jump;
    }
  });
  for (LogEvent& event : events)
    if (event.utime >= when) event.utime += jump;
  return {1.0, at(jump > 0 ? "clock jumps 7 s ahead at" : "clock jumps 7 s back at", when)};
}

Defect freezeIns(int64_t when, int64_t until, std::vector<LogEvent>& events) {
  ins_t frozen{};
  bool cold = false;
  editEach(events, kIns, [&](ins_t& ins) {
    if (ins.utime < when || ins.utime >= until) return;
    if (!cold) frozen = ins;
    cold = true;
    std::copy_n(frozen.position, 3, ins.position);
    std::copy_n(frozen.orientation, 4, ins.orientation);
    std::copy_n(frozen.rate, 3, ins.rate);
  });
  return {1.0, at("INS repeats itself from", when)};
}

Defect flipGyro(int64_t when, std::vector<LogEvent>& events) {
  editEach(events, kIns, [when](ins_t& ins) {
    if (ins.utime >= when) ins.rate[2] = -ins.rate[2];
  });
  return {1.0, at("rate[2] of INS has the wrong sign from", when)};
}

Defect swapTracks(int64_t when, std::vector<LogEvent>& events) {
  editEach(events, kMotor, [when](motor_t& motor) {
    if (motor.utime >= when) std::swap(motor.command[0], motor.command[1]);
  });
  return {1.0, at("left and right of MOTOR are swapped from", when)};
}

Defect mixRobots(const std::vector<LogEvent>& other, std::vector<LogEvent>& events) {
  if (events.empty() || other.empty()) return {};
  // Shifts the second robot's clock to the first one's, as on a common network.
  const int64_t shift = events.front().utime - other.front().utime + 137;
  std::vector<LogEvent> late = other;
  const auto shifted = [&](auto& message) { message.utime += shift; };
  editEach(late, kIns, shifted);
  editEach(late, kMotor, shifted);
  editEach(late, kMark, shifted);
  editEach(late, kConfig, shifted);
  editEach(late, kExecution, [&](execution_t& message) {
    shifted(message);
    for (execution_record_t& record : message.records) {
      record.started += shift;
      if (record.ended >= 0) record.ended += shift;
    }
  });
  for (LogEvent& event : late) event.utime += shift;
  events.insert(events.end(), late.begin(), late.end());
  std::stable_sort(events.begin(), events.end(),
                   [](const LogEvent& a, const LogEvent& b) { return a.utime < b.utime; });
  return {1.0, "two robots on all channels, all the time"};
}

}  // namespace

const std::vector<std::string>& defectNames() {
  static const std::vector<std::string> names{
      "clock_jump", "frozen_ins",         "flipped_gyro",      "truncated",         "no_motor",
      "two_robots", "frozen_for_seconds", "gyro_flips_midway", "tracks_swap_midway"};
  return names;
}

Defect spoil(const std::string& defect, uint64_t seed, const std::vector<LogEvent>& other,
             std::vector<LogEvent>& events) {
  if (events.empty()) return {};
  Rng rng(sim::streamSeed(seed, kEffectStream));
  const auto span = static_cast<double>(events.back().utime - events.front().utime);
  const int64_t when = events.front().utime + static_cast<int64_t>(rng.uniform(0.3, 0.5) * span);
  if (defect == "clock_jump") return jumpClock(rng, when, events);
  if (defect == "frozen_ins") return freezeIns(when, INT64_MAX, events);
  if (defect == "frozen_for_seconds")
    return freezeIns(when, when + static_cast<int64_t>(rng.uniform(10e6, 40e6)), events);
  if (defect == "gyro_flips_midway") return flipGyro(when, events);
  if (defect == "tracks_swap_midway") return swapTracks(when, events);
  if (defect == "flipped_gyro") {
    editEach(events, kIns, [](ins_t& ins) { ins.rate[2] = -ins.rate[2]; });
    return {1.0, "rate[2] of all INS messages has the wrong sign"};
  }
  if (defect == "truncated") return {rng.uniform(0.1, 0.2), "the file ends inside an event"};
  if (defect == "no_motor") {
    const auto is_motor = [](const LogEvent& event) { return event.channel == kMotor.name; };
    events.erase(std::remove_if(events.begin(), events.end(), is_motor), events.end());
    return {1.0, "no message on MOTOR"};
  }
  if (defect == "two_robots") return mixRobots(other, events);
  throw std::invalid_argument("defect '" + defect + "' is unknown; tread-hide list shows them");
}

}  // namespace tread::blind
