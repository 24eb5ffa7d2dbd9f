// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/replay/robot_learner.hpp"

#include <algorithm>
#include <filesystem>
#include <set>
#include <sstream>
#include <stdexcept>

#include "common/messages/pattern_messages.hpp"
#include "common/pattern/pattern_file.hpp"
#include "common/store/store.hpp"
#include "modules/learner/learner_node.hpp"
#include "tools/replay/learner_lives.hpp"
#include "tools/replay/log_bus.hpp"
#include "tools/replay/recipe.hpp"
#include "tools/replay/set_difference.hpp"

namespace tread::replay {
namespace {

/// The replay goes on so long after the log: what was under way comes out [us].
constexpr int64_t kAfterwards = 100'000;

/// Yaw is unwrapped from the first INS on: a replay that begins later rounds otherwise.
constexpr double kMiddleTolerance = 1e-9;

using ExecutionKey = std::pair<int64_t, int64_t>;

/// What the learner said: in the log, or in a replay.
struct Said {
  SetParts sets;
  std::map<ExecutionKey, learning_t> learned;
  std::vector<LogEvent> events;
  /// Said by the replay when the log's learner, or the recorder, may have been gone.
  std::set<int64_t> late_versions;
  std::set<ExecutionKey> late_learned;

  void take(const LogEvent& event) {
    pattern_set_part_t part;
    if (decode(event, kPatternSet, part)) sets[part.set_version].emplace(part.part, part);
    learning_t learning;
    if (decode(event, kLearning, learning)) learned.emplace(keyOf(learning), learning);
  }
  void takeLate(const LogEvent& event) {
    pattern_set_part_t part;
    if (decode(event, kPatternSet, part) && sets.count(part.set_version) == 0)
      late_versions.insert(part.set_version);
    learning_t learning;
    if (decode(event, kLearning, learning) && learned.count(keyOf(learning)) == 0)
      late_learned.insert(keyOf(learning));
  }

 private:
  static ExecutionKey keyOf(const learning_t& learning) {
    return {learning.learned_run_id, learning.learned_execution_id};
  }
};

/// When the log heard the learner for the last time in a life; 0 if never.
int64_t lastWordOf(const RobotLog& log, const LearnerLife& life) {
  for (size_t i = life.end_event; i-- > life.first_event;) {
    const LogEvent& event = log.events[i].event;
    health_t health;
    if (event.channel == kLearning.name || event.channel == kPatternSet.name ||
        event.channel == kLearnerState.name ||
        (decode(event, kHealth, health) && health.process == "learner"))
      return log.events[i].heard;
  }
  return 0;
}

void playLife(const RobotLog& log, const LearnerLife& life,
              const learner::LearnerNodeConfig& config, Said& said) {
  MemoryStore store;
  LogBus bus(life.boot_id);
  learner::LearnerNode node(config, bus, store);
  node.resume(life.state, life.earlier);
  int64_t next_step = log.events[life.first_event].heard;
  const auto stepUntil = [&](int64_t utime) {
    for (; next_step <= utime; next_step += node.period()) {
      bus.setNow(next_step);
      node.step(next_step);
    }
  };
  for (size_t i = life.first_event; i < life.end_event; ++i) {
    const TimedEvent& timed = log.events[i];
    stepUntil(timed.heard);
    bus.setNow(timed.heard);
    bus.hear(timed.event);
  }
  if (life.end_event == log.events.size()) stepUntil(log.events.back().heard + kAfterwards);
  const int64_t late = lastWordOf(log, life) - node.period();
  for (LogEvent& event : bus.takePublished()) {
    if (event.utime > late) said.takeLate(event);
    said.take(event);
    said.events.push_back(std::move(event));
  }
}

Said replayed(const RobotLog& log, const std::vector<LearnerLife>& lives,
              const learner::LearnerNodeConfig& config) {
  Said said;
  for (const LearnerLife& life : lives) playLife(log, life, config, said);
  return said;
}

/// What the log holds from where the replay begins.
Said saidInLog(const RobotLog& log, const LearnerLife& first) {
  Said said;
  for (size_t i = first.first_event; i < log.events.size(); ++i) {
    said.take(log.events[i].event);
  }
  if (!first.from_start)
    for (const ExecutionKey& key : first.state.handled) said.learned.erase(key);
  said.sets.erase(said.sets.begin(), said.sets.lower_bound(first.state.set.version()));
  return said;
}

void note(LearnerCheck& check, const std::string& difference) {
  if (check.first_difference.empty()) check.first_difference = difference;
}

/// What only the replay has is a difference, but for as much as the log is known to lack.
void noteOnlyInReplay(const std::vector<std::string>& names, const RobotLog& log,
                      const std::string& channel, LearnerCheck& check) {
  const auto missing = log.missing.find(channel);
  const int64_t lost = missing == log.missing.end() ? 0 : missing->second;
  if (static_cast<int64_t>(names.size()) > lost)
    note(check, names.front() + ": in the replay, not in the log");
}

std::string partsDifference(const std::map<int32_t, pattern_set_part_t>& log,
                            const std::map<int32_t, pattern_set_part_t>& replay, double tolerance) {
  for (const auto& [number, part] : log) {
    const auto other = replay.find(number);
    if (other == replay.end())
      return "version " + std::to_string(part.set_version) + ", part " + std::to_string(number) +
             ": in the log, not in the replay";
    const std::string difference = differenceOf(part, other->second, tolerance);
    if (!difference.empty()) return difference;
  }
  return "";
}

void compareSets(const RobotLog& log, const Said& in_log, const Said& replay, LearnerCheck& check) {
  for (const auto& [version, parts] : in_log.sets) {
    const auto found = replay.sets.find(version);
    if (found == replay.sets.end()) {
      ++check.versions_only_in_log;
      note(check, "version " + std::to_string(version) + ": in the log, not in the replay");
      continue;
    }
    const std::string difference = partsDifference(parts, found->second, check.tolerance);
    ++(difference.empty() ? check.versions_equal : check.versions_different);
    if (!difference.empty()) note(check, difference);
  }
  std::vector<std::string> only_in_replay;
  for (const auto& [version, parts] : replay.sets) {
    if (in_log.sets.count(version) > 0) continue;
    ++check.versions_only_in_replay;
    if (replay.late_versions.count(version) == 0)
      only_in_replay.push_back("version " + std::to_string(version));
  }
  noteOnlyInReplay(only_in_replay, log, kPatternSet.name, check);
}

void compareLearned(const RobotLog& log, const Said& in_log, const Said& replay,
                    LearnerCheck& check) {
  for (const auto& [key, learned] : in_log.learned) {
    const auto found = replay.learned.find(key);
    if (found == replay.learned.end()) {
      ++check.learning_only_in_log;
      note(check, "LEARNING of execution " + std::to_string(key.second) +
                      ": in the log, not in the replay");
      continue;
    }
    const std::string difference = differenceOf(learned, found->second, check.tolerance);
    ++(difference.empty() ? check.learning_equal : check.learning_different);
    if (!difference.empty()) note(check, difference);
  }
  std::vector<std::string> only_in_replay;
  for (const auto& [key, learned] : replay.learned) {
    if (learned.accepted) ++check.measured;
    if (in_log.learned.count(key) > 0) continue;
    ++check.learning_only_in_replay;
    if (replay.late_learned.count(key) == 0)
      only_in_replay.push_back("LEARNING of execution " + std::to_string(key.second));
  }
  noteOnlyInReplay(only_in_replay, log, kLearning.name, check);
}

bool sameBytes(const std::vector<LogEvent>& a, const std::vector<LogEvent>& b) {
  return a.size() == b.size() &&
         std::equal(a.begin(), a.end(), b.begin(), [](const LogEvent& x, const LogEvent& y) {
           return x.utime == y.utime && x.channel == y.channel && x.bytes == y.bytes;
         });
}

/// The set under the numbers of a shipped one: as a pattern file has it.
std::optional<PatternSet> asShipped(const PatternSet& set, int64_t version) {
  PatternSetContent content = set.content();
  content.version = version;
  content.parent_version = 0;
  std::string why;
  return PatternSet::make(std::move(content), why);
}

std::optional<PatternSet> shippedInLog(const RobotLog& log, int64_t checksum) {
  PatternSetAssembler assembler;
  for (const TimedEvent& timed : log.events) {
    pattern_set_part_t part;
    if (!decode(timed.event, kPatternSet, part)) continue;
    const auto set = assembler.add(part);
    if (!set) continue;
    for (const int64_t version : {int64_t{1}, set->content().parent_version}) {
      const auto shipped = version < 1 ? std::nullopt : asShipped(*set, version);
      if (shipped && shipped->checksum() == checksum) return shipped;
    }
    return std::nullopt;  // what has been learned since hides it
  }
  return std::nullopt;
}

std::optional<PatternSet> shippedInFolder(const std::string& folder, int64_t checksum) {
  std::set<std::filesystem::path> files;
  std::error_code none;
  for (const auto& entry : std::filesystem::directory_iterator(folder, none))
    if (entry.path().extension() == ".yaml") files.insert(entry.path());
  for (const std::filesystem::path& file : files) {
    PatternSet set = readPatternFile(file.string());
    if (set.checksum() == checksum) return set;
  }
  return std::nullopt;
}

}  // namespace

bool LearnerCheck::equal() const {
  return same_twice && first_difference.empty() && versions_equal > 0;
}

learner::LearnerNodeConfig learnerConfigOf(const RobotLog& log,
                                           const std::string& patterns_folder) {
  const auto text = log.configs.find("learner");
  if (text == log.configs.end())
    throw std::runtime_error(log.name +
                             ": no CONFIG of the learner; give its configuration with --config, or "
                             "--model or --patterns for a log without a learner");
  ConfigReader reader = ConfigReader::fromText(text->second, log.name + ", CONFIG of the learner");
  std::string name;
  int64_t checksum = 0;
  reader.text("shipped_set", name, true);
  reader.integer("shipped_checksum", checksum, {0.0, 9.3e18}, "1", true);
  auto shipped = shippedInLog(log, checksum);
  if (!shipped) shipped = shippedInFolder(patterns_folder, checksum);
  if (!shipped)
    throw std::runtime_error(log.name + ": the shipped set '" + name + "' (checksum " +
                             std::to_string(checksum) + ") is neither its first version nor in " +
                             patterns_folder + "; give the learner's configuration with --config");
  learner::LearnerNodeConfig config(*shipped);
  learner::readLearnerSettings(reader, config);
  reader.finish();
  return config;
}

LearnerCheck checkLearner(const RobotLog& log, const learner::LearnerNodeConfig& config) {
  const std::vector<LearnerLife> lives = learnerLives(log, config.shipped);
  LearnerCheck check;
  check.name = log.name;
  check.lives = static_cast<int>(lives.size());
  check.from_start = lives.front().from_start;
  check.tolerance = check.from_start ? 0.0 : kMiddleTolerance;
  const Said in_log = saidInLog(log, lives.front());
  const Said first = replayed(log, lives, config);
  check.same_twice = sameBytes(first.events, replayed(log, lives, config).events);
  if (!in_log.sets.empty()) {
    check.first_version = in_log.sets.begin()->first;
    check.last_version = in_log.sets.rbegin()->first;
  }
  compareSets(log, in_log, first, check);
  compareLearned(log, in_log, first, check);
  check.notes.push_back(intakeLine(log, "learner", playedChannels("learner")));
  for (const char* channel : {"INS", "MOTOR", "EXECUTION", "PATTERN_SET", "LEARNING"})
    if (const auto missing = log.missing.find(channel); missing != log.missing.end())
      check.notes.push_back("the log misses " + std::to_string(missing->second) + " messages on " +
                            channel);
  if (!log.problem.empty()) check.notes.push_back(log.problem);
  return check;
}

std::string reportOf(const LearnerCheck& check) {
  std::ostringstream out;
  out << check.name << ": " << check.lives << (check.lives == 1 ? " life" : " lives")
      << " of the learner, from "
      << (check.from_start ? "its start" : "the first state in the log (numbers compared to 1e-9)")
      << ", versions " << check.first_version << " to " << check.last_version << "\n";
  for (const std::string& line : check.notes) out << "  " << line << "\n";
  out << "  replayed twice: " << (check.same_twice ? "the same bytes" : "NOT the same bytes")
      << "\n  PATTERN_SET: " << check.versions_equal << " versions equal, "
      << check.versions_different << " different, " << check.versions_only_in_log
      << " only in the log, " << check.versions_only_in_replay << " only in the replay\n"
      << "  LEARNING: " << check.learning_equal << " executions equal, " << check.learning_different
      << " different, " << check.learning_only_in_log << " only in the log, "
      << check.learning_only_in_replay << " only in the replay, which measured " << check.measured
      << "\n";
  if (!check.first_difference.empty())
    out << "  first difference: " << check.first_difference << "\n";
  out << check.name << ": learner " << (check.equal() ? "EQUAL" : "DIFFERENT") << "\n";
  return out.str();
}

}  // namespace tread::replay
