// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <cmath>

#include "tools/gap/log_checks.hpp"

namespace tread::gap {
namespace {

constexpr int64_t kOvertaking = 200'000;          // [us] by which messages may come out of order
constexpr int64_t kClockStep = 500'000;           // [us]
constexpr int64_t kLongestLog = 172'800'000'000;  // [us] two days
constexpr size_t kWindow = 200;                   // messages
constexpr size_t kShortWindow = 20;               // messages

/// Least time between message and recording among up to `kWindow` messages [us]: a recorder that
/// was held up for a while has caught up somewhere among them.
int64_t leastDelay(const std::vector<Stamp>& stamps, size_t begin, size_t end) {
  int64_t least = INT64_MAX;
  for (size_t i = begin; i < end; ++i) least = std::min(least, stamps[i].logged - stamps[i].utime);
  return least;
}

/// Whether robot's and recorder's clocks lie differently to each other from here on.
bool clocksPart(const std::vector<Stamp>& stamps, size_t index) {
  const size_t begin = index > kWindow ? index - kWindow : 0;
  const size_t end = std::min(stamps.size(), index + kWindow);
  return std::abs(leastDelay(stamps, begin, index) - leastDelay(stamps, index, end)) > kClockStep;
}

/// Whether recorder and robot run at one pace: a replay may be recorded at any.
bool samePace(const std::vector<Stamp>& stamps) {
  std::vector<double> paces;
  for (size_t i = kShortWindow; i < stamps.size(); i += kShortWindow) {
    const Stamp& before = stamps[i - kShortWindow];
    const auto logged = static_cast<double>(stamps[i].logged - before.logged);
    if (stamps[i].utime > before.utime)
      paces.push_back(logged / static_cast<double>(stamps[i].utime - before.utime));
  }
  if (paces.empty()) return true;
  const auto middle = paces.begin() + static_cast<long>(paces.size() / 2);
  std::nth_element(paces.begin(), middle, paces.end());
  return *middle > 0.8 && *middle < 1.25;
}

/// Time going back, and the robot's clock against the recorder's.
void checkStamps(const std::string& channel, const std::vector<Stamp>& stamps,
                 const LogMessages& messages, NoteBook& notes) {
  size_t overtaken = 0;
  bool recorder_told = false;
  const bool same_pace = samePace(stamps);
  for (size_t i = 1; i < stamps.size(); ++i) {
    const int64_t step = stamps[i].utime - stamps[i - 1].utime;
    const int64_t logged = stamps[i].logged - stamps[i - 1].logged;
    const std::string place = " at " + digits(messages.seconds(stamps[i - 1].utime)) + " s";
    if (step < -kOvertaking)
      return notes.fatal("clock jump: " + channel + " goes back by " +
                         digits(-1e-6 * static_cast<double>(step), 2) + " s" + place +
                         "; cut the log there");
    overtaken += step < 0 ? 1 : 0;
    if (!same_pace || std::abs(logged - step) <= kClockStep || !clocksPart(stamps, i)) continue;
    if (step > kClockStep)
      return notes.fatal("clock jump: " + channel + " goes on by " +
                         digits(1e-6 * static_cast<double>(step), 2) + " s" + place +
                         ", the recorder by " + digits(1e-6 * static_cast<double>(logged), 2) +
                         " s; cut the log there");
    if (!recorder_told)
      notes.note("the recorder's clock jumped" + place + "; the robot's own times are used");
    recorder_told = true;
  }
  if (overtaken > 0)
    notes.note(std::to_string(overtaken) + " messages of " + channel +
               " come out of order; sorted by their own time");
}

}  // namespace

void checkClocks(const LogMessages& messages, NoteBook& notes) {
  checkStamps("MOTOR", messages.motor_stamps, messages, notes);
  checkStamps("INS", messages.ins_stamps, messages, notes);
  checkPauses(messages, notes);
  int64_t last = messages.origin;
  if (!messages.motor.empty()) last = std::max(last, messages.motor.back().utime);
  if (!messages.ins.empty()) last = std::max(last, messages.ins.back().utime);
  if (last - messages.origin > kLongestLog)
    notes.fatal("clock jump: INS and MOTOR span " + digits(messages.seconds(last) / 3600.0) +
                " hours; are both on the robot's clock?");
}

}  // namespace tread::gap
