// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/soundness/channel_checks.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <string>

#include "common/messages/ins_messages.hpp"
#include "common/messages/pattern_messages.hpp"
#include "common/soundness/core/log_validation_motion.hpp"

namespace tread::gap {
namespace {

constexpr double kFrozen = 3.0;        // [s] of a constant pose while driving: the INS hangs
constexpr double kNoticedHold = 1.0;   // [s]
constexpr double kClearCommand = 0.5;  // of the largest one: a robot does not stand still with it
constexpr double kSecondKind = 0.01;   // of the commands

double largestCommand(const std::vector<HeardSpan>& spans) {
  double largest = 0.0;
  for (const HeardSpan& span : spans)
    for (const CommandSample& sample : span.commands.commands)
      largest = std::max(largest, driveOf(span.commands.layout, sample.command));
  return largest;
}

void checkHeld(const std::vector<HeardSpan>& spans, Diagnostics& notes) {
  const double least = kClearCommand * largestCommand(spans);
  size_t poses = 0;
  size_t repeated = 0;
  for (const HeardSpan& span : spans) {
    poses += span.ins.poses;
    repeated += span.ins.repeated;
    for (const HeldPose& held : span.ins.held) {
      if (held.end - held.begin <= kNoticedHold) continue;
      const double driven = drivenBetween(span.commands.layout, span.commands.commands,
                                          span.commands.end, held.begin, held.end, least);
      if (least > 0.0 && driven > kFrozen)
        notes.add(findings::kInsFrozen, {digits(held.begin), digits(held.end)});
      else
        notes.add(findings::kPoseHeld, {digits(held.begin), digits(held.end)});
    }
  }
  if (repeated > 0)
    notes.add(findings::kPosesRepeated,
              {digits(100.0 * static_cast<double>(repeated) / static_cast<double>(poses), 0)});
}

void checkKinds(const SortedLog& log, Diagnostics& notes) {
  size_t power = 0;
  size_t speed = 0;
  size_t invalid = 0;
  for (const motor_t& motor : log.motor) {
    const bool by_hand = motor.bridge_state == motor_t::STATE_MANUAL;
    if (motor.bridge_state != motor_t::STATE_DRIVING && !by_hand) continue;
    power += motor.channel_kind[0] == static_cast<int16_t>(CommandKind::kPower) ? 1 : 0;
    speed += motor.channel_kind[0] == static_cast<int16_t>(CommandKind::kTrackSpeed) ? 1 : 0;
    invalid += obeyed(motor) ? 0 : 1;
  }
  if (static_cast<double>(std::min(power, speed)) >
      kSecondKind * static_cast<double>(power + speed))
    notes.add(findings::kTwoKinds, {std::to_string(power), std::to_string(speed)});
  if (invalid > 0) notes.add(findings::kInvalidCommands, {std::to_string(invalid)});
}

/// Checks for missing INS poses in the middle of a span.
void checkSilences(const std::vector<HeardSpan>& spans, Diagnostics& notes) {
  size_t silences = 0;
  size_t jumps = 0;
  double first_silence = 0.0;
  double first_jump = 0.0;
  for (const HeardSpan& span : spans) {
    double last = span.commands.begin();
    for (const InsReading& reading : span.ins.readings) {
      if (!reading.fresh) continue;
      if (reading.sample.time - last > kInsSilence && silences++ == 0) first_silence = last;
      if (reading.new_track && last > span.commands.begin() && jumps++ == 0)
        first_jump = reading.sample.time;
      last = reading.sample.time;
    }
    if (span.commands.end - last > kInsSilence && silences++ == 0) first_silence = last;
  }
  if (silences > 0)
    notes.add(findings::kInsSilences, {std::to_string(silences), digits(first_silence)});
  if (jumps > 0) notes.add(findings::kJumpsAnnounced, {std::to_string(jumps), digits(first_jump)});
}

void checkCommandGaps(const std::vector<HeardSpan>& spans, Diagnostics& notes) {
  size_t gaps = 0;
  double first = 0.0;
  double longest = 0.0;
  for (size_t i = 1; i < spans.size(); ++i) {
    if (!spans[i].commands.after_silence) continue;
    if (gaps++ == 0) first = spans[i - 1].commands.end;
    longest = std::max(longest, spans[i].commands.begin() - spans[i - 1].commands.end);
  }
  if (gaps > 0)
    notes.add(findings::kMotorSilences, {std::to_string(gaps), digits(first), digits(longest)});
}

constexpr size_t kFewClashes = 5;
constexpr size_t kRepeated =
    20;  // repetitions of a message from which its publisher counts as hanging

bool sameMessage(const Stamp& a, const Stamp& b) {
  return a.seq == b.seq && a.utime == b.utime;
}

/// How often seq does not increase although the message differs.
size_t seqFallsBack(const std::vector<Stamp>& stamps) {
  size_t count = 0;
  bool counts = false;
  for (size_t i = 1; i < stamps.size(); ++i) {
    counts = counts || stamps[i].seq != stamps[0].seq;
    if (stamps[i].seq <= stamps[i - 1].seq && !sameMessage(stamps[i], stamps[i - 1])) ++count;
  }
  return counts ? count : 0;
}

/// Whether messages of the same time contradict each other.
bool clash(const ins_t& a, const ins_t& b) {
  const auto first = planarPose(a);
  const auto second = planarPose(b);
  return a.utime == b.utime && first && second &&
         (first->position() - second->position()).norm() > 1e-6;
}
bool clash(const motor_t& a, const motor_t& b) {
  return a.utime == b.utime && commandFrom(a) != commandFrom(b);
}

/// How often neighbours in the log contradict each other.
template <class Message>
size_t clashes(const std::vector<Message>& messages) {
  size_t count = 0;
  for (size_t i = 1; i < messages.size(); ++i) count += clash(messages[i - 1], messages[i]) ? 1 : 0;
  return count;
}

bool bootsAlternate(std::vector<int64_t> boots) {
  std::sort(boots.begin(), boots.end());
  return std::adjacent_find(boots.begin(), boots.end()) != boots.end();
}

/// Detects one publisher whose clock went back: ordered by their numbers, which have no gap, the
/// messages go back in time once or twice. Returns the last message before that, if any.
std::optional<Stamp> clockWentBack(std::vector<Stamp> stamps) {
  std::stable_sort(stamps.begin(), stamps.end(),
                   [](const Stamp& a, const Stamp& b) { return a.seq < b.seq; });
  std::optional<Stamp> place;
  size_t times = 0;
  for (size_t i = 1; i < stamps.size(); ++i) {
    if (stamps[i].utime >= stamps[i - 1].utime - kOvertaking) continue;
    if (!isNext(stamps[i].seq, stamps[i - 1].seq) || ++times > 2) return std::nullopt;
    if (!place) place = stamps[i - 1];
  }
  return place;
}

void checkRepeated(const std::string& channel, const std::vector<Stamp>& stamps,
                   const SortedLog& log, Diagnostics& notes) {
  size_t run = 1;
  for (size_t i = 1; i < stamps.size(); ++i) {
    run = sameMessage(stamps[i], stamps[i - 1]) ? run + 1 : 1;
    if (run == kRepeated)
      return notes.add(findings::kMessageFrozen, {channel, digits(log.seconds(stamps[i].utime))});
  }
}

void checkChannel(const std::string& channel, const std::vector<Stamp>& stamps, size_t clashes,
                  const SortedLog& log, Diagnostics& notes) {
  checkRepeated(channel, stamps, log, notes);
  const size_t falls = seqFallsBack(stamps);
  if (std::max(falls, clashes) < std::max(kFewClashes, stamps.size() / 100)) {
    if (falls > 0) notes.add(findings::kPublisherRestarts, {channel, std::to_string(falls)});
    return;
  }
  if (const auto place = clockWentBack(stamps))
    return notes.add(findings::kTimesMixed, {channel, digits(log.seconds(place->utime))});
  notes.add(findings::kTwoPublishers, {channel, std::to_string(falls), std::to_string(clashes)});
}

}  // namespace

void checkChannels(const SortedLog& log, const std::vector<HeardSpan>& spans, Diagnostics& notes) {
  const std::string events = std::to_string(log.drive.events.size());
  if (log.motor.empty()) notes.add(findings::kNoMotor, {events});
  if (log.ins.empty()) notes.add(findings::kNoIns, {events});
  if (!log.motor.empty() && spans.empty()) notes.add(findings::kNeverDriven);
  checkKinds(log, notes);
  checkHeld(spans, notes);
  checkSilences(spans, notes);
  checkCommandGaps(spans, notes);
}

void checkPublishers(const SortedLog& log, Diagnostics& notes) {
  checkChannel("MOTOR", log.drive.motor_stamps, clashes(log.drive.motor), log, notes);
  checkChannel("INS", log.drive.ins_stamps, clashes(log.drive.ins), log, notes);
  std::map<std::string, std::vector<int64_t>> boots;  // by process, in order
  for (const config_t& config : log.drive.configs) {
    std::vector<int64_t>& ids = boots[config.config_process];
    if (ids.empty() || ids.back() != config.config_boot_id) ids.push_back(config.config_boot_id);
  }
  for (const auto& [process, ids] : boots)
    if (bootsAlternate(ids)) return notes.add(findings::kTwoBoots, {process});
}

}  // namespace tread::gap
