// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/replay/drive_log_reader.hpp"

#include <algorithm>
#include <filesystem>
#include <set>
#include <stdexcept>

#include "common/vehicle/prediction.hpp"

namespace tread::replay {
namespace {

/// Sorts events into a DriveLog.
class Reader {
 public:
  explicit Reader(DriveLog& log) : log_(log) {}

  void take(LogEvent event) {
    if (event.channel == kMark.name) return takeMark(event);
    const bool good = event.channel == kIns.name         ? isIns(event)
                      : event.channel == kExecution.name ? takeExecution(event)
                      : event.channel == kMotor.name     ? takeMotor(event)
                                                         : false;
    if (good) log_.events.push_back(std::move(event));
  }

 private:
  bool isIns(const LogEvent& event) {
    ins_t ins;
    return counted(decode(event, kIns, ins));
  }

  void takeMark(const LogEvent& event) {
    mark_t mark;
    if (!counted(decode(event, kMark, mark))) return;
    if (mark.mark_kind == "surface") log_.surfaces[mark.utime] = mark.mark_value;
  }

  bool takeExecution(const LogEvent& event) {
    execution_t message;
    if (!counted(decode(event, kExecution, message))) return false;
    for (const execution_record_t& record : message.records) {
      const ExecutionKey key{record.record_run_id, record.record_execution_id};
      if (record.outcome == execution_record_t::OUTCOME_RUNNING || !seen_.insert(key).second)
        continue;
      log_.executions.push_back(record);
    }
    return true;
  }

  bool takeMotor(const LogEvent& event) {
    motor_t motor;
    if (!counted(decode(event, kMotor, motor))) return false;
    if (motor.execution_id == 0 || motor.command_index < 0) return true;
    log_.kind = static_cast<CommandKind>(motor.motor_command_kind);
    log_.commands[{motor.motor_run_id, motor.execution_id}].emplace(
        motor.command_index, TrackCommand{static_cast<double>(motor.command_left),
                                          static_cast<double>(motor.command_right)});
    return true;
  }

  bool counted(bool good) {
    if (!good) ++log_.skipped;
    return good;
  }

  DriveLog& log_;
  std::set<ExecutionKey> seen_;
};

/// The series that was applied in an execution; a sample that the log misses holds the one before.
std::vector<TrackCommand> seriesOf(const std::map<int32_t, TrackCommand>& applied, int32_t count) {
  std::vector<TrackCommand> series;
  TrackCommand held = applied.begin()->second;
  for (int32_t index = 0; index < count; ++index) {
    const auto found = applied.find(index);
    if (found != applied.end()) held = found->second;
    series.push_back(held);
  }
  return series;
}

bool same(const TrackCommand& a, const TrackCommand& b) {
  return a.left == b.left && a.right == b.right;
}

/// A class for each pattern: what it does depends on the steady motion in which it begins.
void addPattern(PatternSetContent& content, const VehicleModel& model, int id,
                std::vector<TrackCommand> commands) {
  MotionPattern pattern;
  pattern.id = id;
  pattern.name = "step " + std::to_string(id);
  pattern.commands = std::move(commands);
  const std::string steady = "steady " + std::to_string(id);
  const MotionClass entry = classOf(model, steady, pattern.commands.front());
  content.classes.push_back(entry);
  pattern.entry_class = pattern.exit_class = steady;
  if (!same(pattern.commands.front(), pattern.commands.back())) {
    pattern.exit_class = "after " + std::to_string(id);
    content.classes.push_back(classOf(model, pattern.exit_class, pattern.commands.back()));
  }
  predict(model, static_cast<double>(content.period_us) * 1e-6, entry, pattern);
  const ExecutionSpread& spread = model.spread;
  if (spread.forward == 0.0 && spread.yaw == 0.0 && spread.crab == 0.0)
    pattern.end_covariance = kUnknownCovariance;
  content.patterns.push_back(std::move(pattern));
}

}  // namespace

std::string DriveLog::surfaceAt(int64_t utime) const {
  const auto after = surfaces.upper_bound(utime);
  return after == surfaces.begin() ? "unknown" : std::prev(after)->second;
}

DriveLog toDriveLog(const std::string& name, std::vector<LogEvent> events) {
  DriveLog log;
  log.name = name;
  Reader reader(log);
  std::stable_sort(events.begin(), events.end(),
                   [](const LogEvent& a, const LogEvent& b) { return a.utime < b.utime; });
  for (LogEvent& event : events) reader.take(std::move(event));
  std::stable_sort(log.executions.begin(), log.executions.end(),
                   [](const auto& a, const auto& b) { return a.ended < b.ended; });
  return log;
}

DriveLog readDriveLog(const std::string& path) {
  LogReader reader(path);
  std::vector<LogEvent> events;
  for (LogEvent event; reader.next(event);) events.push_back(event);
  DriveLog log = toDriveLog(std::filesystem::path(path).stem().string(), std::move(events));
  log.problem = reader.problem();
  if (log.executions.empty())
    throw std::runtime_error(path +
                             ": no execution that has ended; a log with INS, MOTOR and EXECUTION "
                             "is needed (tread-import makes one)");
  return log;
}

PatternSet predictedSet(const DriveLog& log, const VehicleModel& model) {
  if (log.kind != model.kind)
    throw std::runtime_error(log.name + ": its commands are not of the kind of model '" +
                             model.name + "' (power or track speed); give another --model");
  PatternSetContent content;
  content.name = log.name;
  content.kind = model.kind;
  std::set<int> known;
  for (const execution_record_t& record : log.executions) {
    const auto applied = log.commands.find({record.record_run_id, record.record_execution_id});
    if (record.outcome != execution_record_t::OUTCOME_COMPLETED || record.commands_total < 1 ||
        applied == log.commands.end() || !known.insert(record.record_pattern_id).second)
      continue;
    const int64_t period = (record.ended - record.started) / record.commands_total;
    if (!content.patterns.empty() && period != content.period_us)
      throw std::runtime_error(log.name + ": its executions have commands of different periods (" +
                               std::to_string(content.period_us) + " and " +
                               std::to_string(period) + " us); a pattern set has one");
    content.period_us = period;
    addPattern(content, model, record.record_pattern_id,
               seriesOf(applied->second, record.commands_total));
  }
  std::string why = "no completed execution has commands in MOTOR";
  auto set = content.patterns.empty() ? std::nullopt : PatternSet::make(std::move(content), why);
  if (!set) throw std::runtime_error(log.name + ": no pattern set can be made: " + why);
  return *set;
}

}  // namespace tread::replay
