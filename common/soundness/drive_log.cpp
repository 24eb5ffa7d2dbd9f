// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/soundness/drive_log.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <optional>
#include <stdexcept>
#include <utility>

#include "common/config/scalars.hpp"
#include "common/report/page.hpp"
#include "common/soundness/channel_checks.hpp"
#include "common/soundness/clock_checks.hpp"
#include "common/soundness/clock_offset.hpp"
#include "common/soundness/core/log_validation.hpp"
#include "common/soundness/segments.hpp"
#include "common/store/store.hpp"

namespace tread::gap {
namespace {

constexpr double kManyBroken = 0.2;  // of the segments

/// The most frequent kind of command while driving.
CommandKind kindOf(const SortedLog& log) {
  std::map<int16_t, size_t> counts;
  for (const motor_t& motor : log.motor)
    if (motor.bridge_state == motor_t::STATE_DRIVING || motor.bridge_state == motor_t::STATE_MANUAL)
      ++counts[motor.channel_kind[0]];
  const auto power = static_cast<int16_t>(CommandKind::kPower);
  const auto speed = static_cast<int16_t>(CommandKind::kTrackSpeed);
  return counts[speed] > counts[power] ? CommandKind::kTrackSpeed : CommandKind::kPower;
}

std::vector<HeardSpan> heardSpans(const SortedLog& log) {
  std::vector<HeardSpan> spans;
  for (CommandSpan& span : knownCommands(log)) {
    SpanReadings readings = insReadings(log, span);
    spans.push_back({std::move(span), std::move(readings)});
  }
  return spans;
}

/// The completed executions, in order of their begin.
std::vector<Execution> recordsOf(const SortedLog& log) {
  std::vector<execution_record_t> records;
  for (const execution_record_t& record : log.drive.executions)
    if (record.outcome == execution_record_t::OUTCOME_COMPLETED && record.ended > record.started)
      records.push_back(record);
  std::sort(records.begin(), records.end(), [](const auto& a, const auto& b) {
    return std::pair(a.started, keyOf(a)) < std::pair(b.started, keyOf(b));
  });
  std::vector<Execution> executions;
  for (const execution_record_t& record : records)
    executions.push_back({0, log.seconds(record.started), log.seconds(record.ended)});
  return executions;
}

/// Removes steps of a recording whose poses are in a wrong frame.
void takeOutBroken(Drive& drive, Diagnostics& notes) {
  const std::vector<size_t> broken = brokenSegments(drive);
  if (broken.empty()) return;
  const bool many =
      static_cast<double>(broken.size()) > kManyBroken * static_cast<double>(drive.segments.size());
  notes.add(findings::kSegmentsLeftOut,
            {std::to_string(broken.size()), std::to_string(drive.segments.size()),
             digits(drive.segments[broken.front()].begin()),
             many ? "too many to be exceptions, so they stay" : "left out"});
  if (!many) removeSegments(broken, drive);
}

constexpr double kSameGauge = 0.02;  // relative: accuracy of tape measures and data sheets

/// The text after "key: " at the beginning of a line; empty if there is no such line.
std::string valueOf(const std::string& text, const std::string& key) {
  const std::string begin = "\n" + key + ": ";
  const size_t at = ("\n" + text).find(begin);
  if (at == std::string::npos) return "";
  const size_t from = at + begin.size() - 1;
  std::string value = text.substr(from, text.find('\n', from) - from);
  if (value.size() >= 2 && value.front() == '"' && value.back() == '"')
    value = value.substr(1, value.size() - 2);
  return value;
}

/// The notes of two imports, if both have them and they differ.
std::optional<std::pair<std::string, std::string>> otherwise(const Drive& first,
                                                             const Drive& second,
                                                             std::string ImportNote::*what) {
  if (!first.imported || !second.imported) return std::nullopt;
  const std::string& one = (*first.imported).*what;
  const std::string& two = (*second.imported).*what;
  if (one.empty() || two.empty() || one == two) return std::nullopt;
  return std::pair{one, two};
}

/// The note of tread-import in CONFIG about its recording; nullopt for other processes.
std::optional<ImportNote> importNoteOf(const config_t& config) {
  if (config.config_process != "tread-import") return std::nullopt;
  const std::string& text = config.config_text;
  ImportNote note;
  note.robot = valueOf(text, "robot");
  const double baseline = parseNumber(valueOf(text, "baseline")).value_or(0.0);
  if (baseline > 0.05 && baseline < 10.0) note.baseline = baseline;
  const std::string poses = valueOf(text, "poses");
  const std::string gyro = valueOf(text, "gyro");
  if (!poses.empty() && !gyro.empty())
    note.options = "--format " + valueOf(text, "format") + ", poses " + poses + ", gyro " + gyro;
  return note;
}

}  // namespace

Drive toDrive(const DriveLog& messages) {
  const SortedLog log(messages);
  const std::vector<HeardSpan> spans = heardSpans(log);
  Drive drive;
  drive.name = messages.name;
  drive.kind = kindOf(log);
  drive.layout = log.layout;
  for (const config_t& config : messages.configs)
    if (auto note = importNoteOf(config)) drive.imported = std::move(note);
  drive.voltage = voltageSamples(log);
  drive.encoders = encoderSamples(log);
  drive.currents = currentSamples(log);
  drive.segments = segmentsOf(spans, drive.encoders);
  drive.executions = executionsOf(drive.layout, drive.segments, recordsOf(log));
  Diagnostics notes(drive.name);
  for (const std::string& note : messages.notes) notes.add(findings::kFileNote, {note});
  checkPublishers(log, notes);
  checkOffset(log, spans, notes);
  checkClocks(log, drive.imported ? Numbering::kByImport : Numbering::kByRobot, notes);
  checkChannels(log, spans, notes);
  if (drive.layout != VehicleLayout::kOmni) takeOutBroken(drive, notes);
  drive.notes = notes.notes();
  const std::vector<LogNote> rest = validateLog(drive);
  drive.notes.insert(drive.notes.end(), rest.begin(), rest.end());
  return drive;
}

Drive readDrive(const std::string& path) {
  const DriveLog log = readDriveLog({path});
  const std::vector<LogEvent>& events = log.events;
  if (events.empty())
    throw std::runtime_error(
        log.damage.empty() ? "log " + path + ": no event in it; is this an LCM log?" : log.damage);
  Drive drive = toDrive(log);
  drive.sha256 = sha256(readText(path));
  if (log.damage.empty()) return drive;
  // Intact events are as good as in an intact log; later checks decide whether they suffice.
  const double span = 1e-6 * static_cast<double>(events.back().utime - events.front().utime);
  drive.lost = log.damage + "; its " + std::to_string(events.size()) + " whole events, " +
               digits(span, 0) + " s, are used; copy the log again if the robot still has it";
  drive.notes.insert(drive.notes.begin(), LogNote{drive.name, drive.lost});
  return drive;
}

void requireSameGauge(const Drive& drive, double gauge) {
  if (!drive.imported || drive.imported->baseline <= 0.0) return;
  const double recorded = drive.imported->baseline;
  if (std::abs(recorded - gauge) <= kSameGauge * gauge) return;
  throw std::runtime_error(
      drive.name + ": its commands were made for tracks " + formatNumber(recorded) +
      " m apart, the model says gauge: " + formatNumber(gauge) + "; give a model of this robot");
}

void requireSameImport(const Drive& first, const Drive& second) {
  if (const auto other = otherwise(first, second, &ImportNote::options))
    throw std::runtime_error(second.name + ": imported with " + other->second + ", but " +
                             first.name + " with " + other->first +
                             "; import both in the same way");
}

void requireSameRobot(const Drive& first, const Drive& second) {
  if (const auto other = otherwise(first, second, &ImportNote::robot))
    throw std::runtime_error(second.name + ": of the robot " + other->second + ", but " +
                             first.name + " of the robot " + other->first +
                             "; give logs of one robot");
}

Drive readDriveFor(const ModelDocument& model, const std::string& path) {
  Drive drive = readDrive(path);
  const VehicleLayout layout = model.vehicle.layout();
  if (!drive.segments.empty() && drive.layout != layout)
    throw std::runtime_error(path + ": its commands are those of " + nameOf(drive.layout) +
                             ", the model is of " + nameOf(layout) +
                             "; give a model of this robot");
  if (layout == VehicleLayout::kTracks) requireSameGauge(drive, model.vehicle.gauge);
  if (drive.segments.empty() || drive.kind == model.vehicle.kind) return drive;
  const bool power = drive.kind == CommandKind::kPower;
  throw std::runtime_error(path + ": its commands are " + (power ? "powers" : "track speeds") +
                           ", those of the model " + (power ? "track speeds" : "powers") +
                           "; give a model with kind: " + (power ? "power" : "track_speed"));
}

Drive readSoundDriveFor(const ModelDocument& model, const std::string& path) {
  Drive drive = readDriveFor(model, path);
  for (const LogNote& note : drive.notes)
    if (note.isFatal()) throw std::runtime_error(path + ": " + note.what);
  if (drive.executions.empty())
    throw std::runtime_error(path + ": nothing was driven for two seconds; give a log of a drive");
  return drive;
}

}  // namespace tread::gap
