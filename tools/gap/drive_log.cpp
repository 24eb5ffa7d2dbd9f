// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/gap/drive_log.hpp"

#include <algorithm>
#include <filesystem>
#include <map>
#include <stdexcept>

#include "common/report/hash.hpp"
#include "modules/identification/core/hygiene.hpp"
#include "tools/gap/known_commands.hpp"
#include "tools/gap/log_checks.hpp"
#include "tools/gap/log_messages.hpp"
#include "tools/gap/stretches.hpp"

namespace tread::gap {
namespace {

constexpr double kManyBroken = 0.2;  // of the stretches

/// The kind of most commands while it drove.
CommandKind kindOf(const LogMessages& messages) {
  std::map<int16_t, size_t> counts;
  for (const motor_t& motor : messages.motor)
    if (motor.bridge_state == motor_t::STATE_DRIVING) ++counts[motor.motor_command_kind];
  const auto power = static_cast<int16_t>(CommandKind::kPower);
  const auto speed = static_cast<int16_t>(CommandKind::kTrackSpeed);
  return counts[speed] > counts[power] ? CommandKind::kTrackSpeed : CommandKind::kPower;
}

std::vector<HeardSpan> heardSpans(const LogMessages& messages) {
  std::vector<HeardSpan> spans;
  for (CommandSpan& span : knownCommands(messages)) {
    SpanReadings readings = insReadings(messages, span);
    spans.push_back({std::move(span), std::move(readings)});
  }
  return spans;
}

std::vector<Execution> recordsOf(const LogMessages& messages) {
  std::vector<Execution> records;
  for (const execution_record_t& record : messages.executions)
    records.push_back({0, messages.seconds(record.started), messages.seconds(record.ended)});
  return records;
}

/// Steps of a recording whose poses lie in a wrong frame say nothing.
void takeOutBroken(Drive& drive, NoteBook& notes) {
  const std::vector<size_t> broken = brokenStretches(drive);
  if (broken.empty()) return;
  const std::string of =
      std::to_string(broken.size()) + " of " + std::to_string(drive.stretches.size()) +
      " stretches have poses in a wrong frame (heading against gyro, or way against heading), "
      "first at " +
      digits(drive.stretches[broken.front()].begin()) + " s";
  if (static_cast<double>(broken.size()) >
      kManyBroken * static_cast<double>(drive.stretches.size()))
    return notes.note(of + "; too many to be exceptions, so they stay");
  notes.note(of + "; left out");
  removeStretches(broken, drive);
}

}  // namespace

Drive toDrive(const std::string& name, const std::vector<LogEvent>& events) {
  const LogMessages messages = sortMessages(events);
  const std::vector<HeardSpan> spans = heardSpans(messages);
  Drive drive;
  drive.name = name;
  drive.kind = kindOf(messages);
  drive.imported = messages.imported;
  drive.voltage = voltageSamples(messages);
  drive.encoders = encoderSamples(messages);
  drive.stretches = stretchesOf(spans, drive.encoders);
  drive.executions = executionsOf(drive.stretches, recordsOf(messages));
  NoteBook notes(name);
  checkPublishers(messages, notes);
  checkClocks(messages, notes);
  checkChannels(messages, spans, notes);
  takeOutBroken(drive, notes);
  drive.notes = notes.notes();
  const std::vector<HygieneNote> rest = checkHygiene(drive);
  drive.notes.insert(drive.notes.end(), rest.begin(), rest.end());
  return drive;
}

Drive readDrive(const std::string& path) {
  LogReader reader(path);
  std::vector<LogEvent> events;
  for (LogEvent event; reader.next(event);) events.push_back(event);
  if (events.empty())
    throw std::runtime_error(reader.problem().empty()
                                 ? "log " + path + ": no event in it; is this an LCM log?"
                                 : reader.problem());
  Drive drive = toDrive(std::filesystem::path(path).filename().string(), events);
  drive.sha256 = sha256OfFile(path);
  if (reader.problem().empty()) return drive;
  // Whole events are as good as in a whole log; whether they are enough is judged later.
  const double span = 1e-6 * static_cast<double>(events.back().utime - events.front().utime);
  drive.lost = reader.problem() + "; its " + std::to_string(events.size()) + " whole events, " +
               digits(span, 0) + " s, are used; copy the log again if the robot still has it";
  drive.notes.insert(drive.notes.begin(), HygieneNote{drive.name, drive.lost, false});
  return drive;
}

}  // namespace tread::gap
