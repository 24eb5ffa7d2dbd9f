// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/replay/learner_replay.hpp"

#include <algorithm>
#include <filesystem>
#include <set>
#include <stdexcept>

#include "common/drive/node_replay.hpp"
#include "common/messages/pattern_messages.hpp"
#include "common/vehicle/kernel.hpp"

namespace tread::replay {
namespace {

/// The applied commands of an execution, by index.
using AppliedCommands = std::map<int32_t, Command>;

std::map<ExecutionKey, AppliedCommands> appliedCommands(const DriveLog& log) {
  std::map<ExecutionKey, AppliedCommands> commands;
  for (const motor_t& motor : log.motor)
    if (motor.execution_id != 0 && motor.command_index >= 0)
      commands[{motor.motor_run_id, motor.execution_id}].emplace(motor.command_index,
                                                                 commandFrom(motor));
  return commands;
}

/// Kinds of the last command of an execution; if there is none, those of a model.
std::vector<CommandKind> kindsIn(const DriveLog& log, const VehicleModel& model) {
  for (auto motor = log.motor.rbegin(); motor != log.motor.rend(); ++motor)
    if (motor->execution_id != 0 && motor->command_index >= 0) return kindsFrom(*motor);
  return kindsOf(model.channels());
}

/// The applied series of an execution; a sample missing in the log holds the previous command.
std::vector<Command> seriesOf(const AppliedCommands& applied, int32_t count) {
  std::vector<Command> series;
  Command held = applied.begin()->second;
  for (int32_t index = 0; index < count; ++index) {
    const auto found = applied.find(index);
    if (found != applied.end()) held = found->second;
    series.push_back(held);
  }
  return series;
}

/// One class per pattern, as its motion depends on the steady motion in which it begins.
void addPattern(PatternSetContent& content, const VehicleModel& model, int id,
                const std::vector<Command>& commands) {
  MotionPattern pattern;
  pattern.id = id;
  pattern.name = "step " + std::to_string(id);
  pattern.commands = commands;
  const std::string steady = "steady " + std::to_string(id);
  const MotionClass entry = classOf(model, steady, commands.front());
  content.classes.push_back(entry);
  pattern.entry_class = pattern.exit_class = steady;
  if (pattern.commands.front() != pattern.commands.back()) {
    pattern.exit_class = "after " + std::to_string(id);
    content.classes.push_back(classOf(model, pattern.exit_class, commands.back()));
  }
  predict(model, static_cast<double>(content.period_us) * 1e-6, entry, pattern);
  const ExecutionSpread& spread = model.spread;
  if (spread.forward == 0.0 && spread.yaw == 0.0 && spread.crab == 0.0)
    pattern.end_covariance = kUnknownCovariance;
  content.patterns.push_back(std::move(pattern));
}

constexpr int64_t kSecond = 1'000'000;

/// Names the set version with which a replayed learner scores each execution.
class Scoring {
 public:
  explicit Scoring(Commitment commitment) : commitment_(commitment) {}

  /// The event with the versions that this learner has published, if it is EXECUTION.
  LogEvent scored(const LogEvent& event, int64_t newest) {
    execution_t message;
    if (!decode(event, kExecution, message)) return event;
    for (execution_record_t& record : message.records)
      record.record_set_version = versionFor(record, newest);
    LogEvent scored = eventOf(kExecution, message);
    scored.utime = event.utime;
    return scored;
  }

 private:
  int64_t versionFor(const execution_record_t& record, int64_t newest) {
    const bool running = record.outcome == execution_record_t::OUTCOME_RUNNING;
    if (commitment_ == Commitment::kPrompt && running) return newest;
    return versions_.emplace(keyOf(record), newest).first->second;
  }

  Commitment commitment_;
  std::map<ExecutionKey, int64_t> versions_;
};

/// Adds a message of the learner to its run.
void note(const LogEvent& event, LearnerRun& run) {
  learning_t learned;
  if (decode(event, kLearning, learned)) run.learned.push_back(learned);
  health_t health;
  if (!decode(event, kHealth, health)) return;
  run.health = health.health_reason;
  for (const counter_t& counter : health.counters)
    run.counters[counter.counter_name] = counter.counted;
}

/// The learner's inputs from a log, with executions ordered by their ends.
DriveLog learnersPart(DriveLog log) {
  const auto ignore = [](const auto&) {};
  log.events.erase(std::remove_if(log.events.begin(), log.events.end(),
                                  [&](const LogEvent& event) {
                                    return !dispatch(event, ignore, kIns, kExecution, kMotor);
                                  }),
                   log.events.end());
  std::stable_sort(log.executions.begin(), log.executions.end(),
                   [](const auto& a, const auto& b) { return a.ended < b.ended; });
  return log;
}

}  // namespace

DriveLog toLearnerLog(const std::string& name, std::vector<LogEvent> events) {
  return learnersPart(toDriveLog(name, std::move(events)));
}

DriveLog readLearnerLog(const std::string& path) {
  DriveLog log = learnersPart(readDriveLog({path}));
  log.name = std::filesystem::path(path).stem().string();
  if (log.executions.empty())
    throw std::runtime_error(path +
                             ": no completed execution; a log with INS, MOTOR and EXECUTION "
                             "is needed (tread-import makes one)");
  return log;
}

PatternSet predictedSet(const DriveLog& log, const VehicleModel& model) {
  if (kindsIn(log, model) != kindsOf(model.channels()))
    throw std::runtime_error(log.name + ": its commands are not of the kind of model '" +
                             model.name +
                             "' (power, track speed or steering); give another --model");
  PatternSetContent content;
  content.name = log.name;
  content.channels = model.channels();
  const std::map<ExecutionKey, AppliedCommands> commands = appliedCommands(log);
  std::set<int> known;
  for (const execution_record_t& record : log.executions) {
    const auto applied = commands.find(keyOf(record));
    if (record.outcome != execution_record_t::OUTCOME_COMPLETED || record.commands_total < 1 ||
        applied == commands.end() || !known.insert(record.record_pattern_id).second)
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

LearnerRun runLearner(const DriveLog& log, const learner::LearnerNodeConfig& config,
                      Commitment commitment, const std::string& title) {
  LearnerRun run;
  run.title = title;
  if (log.events.empty()) return run;
  const int64_t start = std::max<int64_t>(1, log.events.front().utime - kSecond);
  NodeReplay<learner::LearnerNode> replay(
      config, start, [&run](const LogEvent& event) { note(event, run); }, start);
  Scoring scoring(commitment);
  for (const LogEvent& event : log.events) {
    replay.stepUntil(event.utime);
    replay.play(scoring.scored(event, replay.node().set().version()));
  }
  // Executions without INS at their end are given up after a while; HEALTH follows within 1 s.
  replay.stepUntil(log.events.back().utime + config.settle_us + config.give_up_us + 2 * kSecond);
  run.set = replay.node().set();
  return run;
}

}  // namespace tread::replay
