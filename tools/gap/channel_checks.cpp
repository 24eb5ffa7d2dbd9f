// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <cmath>

#include "tools/gap/log_checks.hpp"

namespace tread::gap {
namespace {

constexpr double kFrozen = 3.0;        // [s] of one pose while it drives: the INS hangs
constexpr double kNoticedHold = 1.0;   // [s]
constexpr double kClearCommand = 0.5;  // of the largest one: nobody stands still with it
constexpr double kSilence = 1.5;       // [s] of the INS
constexpr double kSecondKind = 0.01;   // of the commands

double sizeOf(const TrackCommand& command) {
  return std::max(std::abs(command.left), std::abs(command.right));
}

double largestCommand(const std::vector<HeardSpan>& spans) {
  double largest = 0.0;
  for (const HeardSpan& span : spans)
    for (const CommandSample& sample : span.commands.commands)
      largest = std::max(largest, sizeOf(sample.command));
  return largest;
}

/// Seconds of clear commands between two times.
double drivenBetween(const CommandSpan& span, double begin, double end, double least) {
  double sum = 0.0;
  for (size_t i = 0; i < span.commands.size(); ++i) {
    const double from = std::max(begin, span.commands[i].time);
    const double to =
        std::min(end, i + 1 < span.commands.size() ? span.commands[i + 1].time : span.end);
    if (to > from && sizeOf(span.commands[i].command) >= least) sum += to - from;
  }
  return sum;
}

void checkHeld(const std::vector<HeardSpan>& spans, NoteBook& notes) {
  const double least = kClearCommand * largestCommand(spans);
  size_t poses = 0;
  size_t repeated = 0;
  for (const HeardSpan& span : spans) {
    poses += span.ins.poses;
    repeated += span.ins.repeated;
    for (const HeldPose& held : span.ins.held) {
      if (held.end - held.begin <= kNoticedHold) continue;
      const double driven = drivenBetween(span.commands, held.begin, held.end, least);
      if (least > 0.0 && driven > kFrozen)
        notes.fatal("the INS is frozen: one pose from " + digits(held.begin) + " to " +
                    digits(held.end) +
                    " s while commands drive; cut the log before, check the INS");
      else
        notes.note("one pose from " + digits(held.begin) + " to " + digits(held.end) +
                   " s; not used as measurement");
    }
  }
  if (repeated > 0)
    notes.note("the INS repeats its pose in " +
               digits(100.0 * static_cast<double>(repeated) / static_cast<double>(poses), 0) +
               " % of its messages while it drives; only new poses count");
}

void checkKinds(const LogMessages& messages, NoteBook& notes) {
  size_t power = 0;
  size_t speed = 0;
  size_t senseless = 0;
  for (const motor_t& motor : messages.motor) {
    if (motor.bridge_state != motor_t::STATE_DRIVING) continue;
    power += motor.motor_command_kind == static_cast<int16_t>(CommandKind::kPower) ? 1 : 0;
    speed += motor.motor_command_kind == static_cast<int16_t>(CommandKind::kTrackSpeed) ? 1 : 0;
    senseless += obeyed(motor) ? 0 : 1;
  }
  if (static_cast<double>(std::min(power, speed)) >
      kSecondKind * static_cast<double>(power + speed))
    notes.fatal("commands of two kinds: " + std::to_string(power) + " power, " +
                std::to_string(speed) + " track speed; cut the log where the kind changes");
  if (senseless > 0)
    notes.note(std::to_string(senseless) + " MOTOR messages without a number as command; left out");
}

/// INS poses that stay away in the middle of a span.
void checkSilences(const std::vector<HeardSpan>& spans, NoteBook& notes) {
  size_t silences = 0;
  size_t jumps = 0;
  double first_silence = 0.0;
  double first_jump = 0.0;
  for (const HeardSpan& span : spans) {
    double last = span.commands.begin();
    for (const InsReading& reading : span.ins.readings) {
      if (!reading.fresh) continue;
      if (reading.sample.time - last > kSilence && silences++ == 0) first_silence = last;
      if (reading.new_track && last > span.commands.begin() && jumps++ == 0)
        first_jump = reading.sample.time;
      last = reading.sample.time;
    }
    if (span.commands.end - last > kSilence && silences++ == 0) first_silence = last;
  }
  if (silences > 0)
    notes.note("no new INS pose for more than 1.5 s " + std::to_string(silences) +
               " times, first at " + digits(first_silence) + " s; driving there is not used");
  if (jumps > 0)
    notes.note("the INS announces " + std::to_string(jumps) + " jumps, first at " +
               digits(first_jump) + " s; each begins a new stretch");
}

void checkCommandGaps(const std::vector<HeardSpan>& spans, NoteBook& notes) {
  size_t gaps = 0;
  double first = 0.0;
  double longest = 0.0;
  for (size_t i = 1; i < spans.size(); ++i) {
    if (spans[i].commands.before != Before::kMotorSilent) continue;
    if (gaps++ == 0) first = spans[i - 1].commands.end;
    longest = std::max(longest, spans[i].commands.begin() - spans[i - 1].commands.end);
  }
  if (gaps > 0)
    notes.note("MOTOR is silent for more than 0.3 s " + std::to_string(gaps) + " times (first at " +
               digits(first) + " s, longest " + digits(longest) +
               " s); each silence ends a stretch");
}

}  // namespace

void checkChannels(const LogMessages& messages, const std::vector<HeardSpan>& spans,
                   NoteBook& notes) {
  const std::string of = " among " + std::to_string(messages.events) + " events";
  if (messages.motor.empty())
    notes.fatal("no MOTOR message" + of + ": the commands are unknown; record channel MOTOR");
  if (messages.ins.empty())
    notes.fatal("no INS message" + of + ": the motion is unknown; record channel INS");
  if (messages.foreign > 0)
    notes.note(
        std::to_string(messages.foreign) +
        " events on our channels are of another type or time; left out (another version's log?)");
  if (!messages.motor.empty() && spans.empty())
    notes.fatal("the bridge never drives or stands armed for a second: no command is known");
  checkKinds(messages, notes);
  checkHeld(spans, notes);
  checkSilences(spans, notes);
  checkCommandGaps(spans, notes);
}

}  // namespace tread::gap
