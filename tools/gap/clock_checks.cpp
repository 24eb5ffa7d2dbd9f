// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <cmath>
#include <optional>

#include "common/messages/ins_messages.hpp"
#include "tools/gap/log_checks.hpp"

namespace tread::gap {
namespace {

constexpr int64_t kOvertaking = 200'000;          // [us] by which messages may come out of order
constexpr int64_t kClockStep = 500'000;           // [us]
constexpr int64_t kLongestLog = 172'800'000'000;  // [us] two days
constexpr double kMoving = 0.3;                   // [m/s]
constexpr int64_t kLongStep = 1'000'000;          // [us] that no driver needs between two messages
constexpr size_t kFewClashes = 5;
constexpr size_t kWindow = 200;      // messages
constexpr size_t kShortWindow = 20;  // messages

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

/// A moving INS message with its neighbour.
struct Moving {
  Pose2 pose;
  double speed;
};

std::optional<Moving> movingAt(const std::vector<ins_t>& ins, size_t index, size_t neighbour) {
  const auto pose = planarPose(ins[index]);
  const auto other = planarPose(ins[neighbour]);
  const int64_t step = std::abs(ins[index].utime - ins[neighbour].utime);
  if (!pose || !other || step == 0 || step > kClockStep) return std::nullopt;
  const double speed =
      (pose->position() - other->position()).norm() / (1e-6 * static_cast<double>(step));
  if (speed < kMoving) return std::nullopt;
  return Moving{*pose, speed};
}

/// A pause after which the robot is where it was one message later: time went on, the robot did
/// not.
void checkPauses(const LogMessages& messages, NoteBook& notes) {
  const std::vector<ins_t>& ins = messages.ins;
  for (size_t i = 2; i + 1 < ins.size(); ++i) {
    const int64_t step = ins[i].utime - ins[i - 1].utime;
    const bool announced = (ins[i].ins_status & ins_t::STATUS_JUMP) != 0;
    if (step < kLongStep || announced || ins[i].seq != ins[i - 1].seq + 1) continue;
    const auto before = movingAt(ins, i - 1, i - 2);
    const auto after = movingAt(ins, i, i + 1);
    if (!before || !after) continue;
    const double speed = 0.5 * (before->speed + after->speed);
    const double moved = (after->pose.position() - before->pose.position()).norm();
    const double usual = speed * 1e-6 * static_cast<double>(ins[i - 1].utime - ins[i - 2].utime);
    const double turned = std::abs(wrapAngle(after->pose.yaw - before->pose.yaw));
    if (moved > 2.0 * usual + 0.05 || moved > 0.3 * speed * 1e-6 * static_cast<double>(step) ||
        turned > 0.4)
      continue;
    return notes.fatal("clock jump: INS goes on by " + digits(1e-6 * static_cast<double>(step), 2) +
                       " s at " + digits(messages.seconds(ins[i - 1].utime)) +
                       " s, but the robot moves on by " + digits(moved, 2) + " m at " +
                       digits(speed, 2) + " m/s; cut the log there");
  }
}

/// How often seq does not grow although the message is another one.
size_t seqFallsBack(const std::vector<Stamp>& stamps) {
  size_t count = 0;
  bool counts = false;
  for (size_t i = 1; i < stamps.size(); ++i) {
    counts = counts || stamps[i].seq != stamps[0].seq;
    const bool same = stamps[i].seq == stamps[i - 1].seq && stamps[i].utime == stamps[i - 1].utime;
    if (stamps[i].seq <= stamps[i - 1].seq && !same) ++count;
  }
  return counts ? count : 0;
}

bool bootsAlternate(std::vector<int64_t> boots) {
  std::sort(boots.begin(), boots.end());
  return std::adjacent_find(boots.begin(), boots.end()) != boots.end();
}

void checkChannel(const std::string& channel, const std::vector<Stamp>& stamps, size_t clash_count,
                  NoteBook& notes) {
  const size_t falls = seqFallsBack(stamps);
  if (std::max(falls, clash_count) >= std::max(kFewClashes, stamps.size() / 100))
    return notes.fatal("two robots in one log: " + channel +
                       " has two publishers (its seq falls back " + std::to_string(falls) +
                       " times, " + std::to_string(clash_count) +
                       " messages contradict another one of the same time); record one robot");
  if (falls > 0)
    notes.note(channel + "'s publisher was started again " + std::to_string(falls) +
               " times, or messages came out of order");
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

void checkPublishers(const LogMessages& messages, NoteBook& notes) {
  checkChannel("MOTOR", messages.motor_stamps, messages.motor_clashes, notes);
  checkChannel("INS", messages.ins_stamps, messages.ins_clashes, notes);
  for (const auto& [process, boots] : messages.boots)
    if (bootsAlternate(boots))
      return notes.fatal("two robots in one log: CONFIG of " + process +
                         " alternates between two boots; record one robot");
}

}  // namespace tread::gap
