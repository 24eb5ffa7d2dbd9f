// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/replay/robot_learner.hpp"

#include "tools/lab/replay/robot_planner.hpp"
#include "tools/lab/replay/robot_replay.hpp"

#include <filesystem>
#include <set>
#include <sstream>
#include <stdexcept>

#include "common/drive/node_replay.hpp"
#include "common/messages/pattern_messages.hpp"
#include "common/pattern/pattern_file.hpp"
#include "tools/lab/replay/learner_lives.hpp"

namespace tread::replay {
namespace {

/// The replay continues after the log, for output that is still pending [us].
constexpr int64_t kAfterwards = 100'000;

/// Yaw is unwrapped from the first INS on, so a replay with a later start rounds differently.
constexpr double kMiddleTolerance = 1e-9;

using SetParts = std::map<int32_t, pattern_set_part_t>;

/// Messages published by a learner, in the log or in a replay.
struct Published {
  std::map<int64_t, SetParts> sets;  ///< by version and part number
  std::map<ExecutionKey, learning_t> learned;
  std::vector<LogEvent> events;
  /// Published by the replay when the log's learner, or the recorder, may already have stopped.
  std::set<int64_t> late_versions;
  std::set<ExecutionKey> late_learned;

  void take(const LogEvent& event, bool late = false) {
    pattern_set_part_t part;
    if (decode(event, kPatternSet, part)) {
      if (late && sets.count(part.set_version) == 0) late_versions.insert(part.set_version);
      sets[part.set_version].emplace(part.part, part);
    }
    learning_t learning;
    if (!decode(event, kLearning, learning)) return;
    const ExecutionKey key{learning.learned_run_id, learning.learned_execution_id};
    if (learned.emplace(key, learning).second && late) late_learned.insert(key);
  }
};

/// Time of the learner's last message in a life; 0 if it published none.
int64_t lastMessageOf(const RobotLog& log, const LearnerLife& life) {
  const auto [from, to] = notesBetween(log.healthOf("learner"), life.first_event, life.end_event);
  const size_t health = from == to ? life.first_event : std::prev(to)->event;
  for (size_t i = life.end_event; i-- > health;) {
    const std::string& channel = log.events[i].channel;
    if (channel == kLearning.name || channel == kPatternSet.name || channel == kLearnerState.name)
      return log.events[i].utime;
  }
  return from == to ? 0 : log.events[health].utime;
}

/// Times of the learner's steps that are known because they published HEALTH [us].
std::vector<int64_t> knownSteps(const RobotLog& log, const LearnerLife& life) {
  std::vector<int64_t> steps;
  const auto [from, to] = notesBetween(log.healthOf("learner"), life.first_event, life.end_event);
  for (auto health = from; health != to; ++health)
    if (steps.empty() || health->message.utime > steps.back())
      steps.push_back(health->message.utime);
  return steps;
}

void playLife(const RobotLog& log, const LearnerLife& life,
              const learner::LearnerNodeConfig& config, Published& published) {
  // Messages just before or after a step decide what it publishes: steps are at the known times,
  // and one period apart in between.
  const int64_t period = config.period_us;
  const int64_t begin = log.events[life.first_event].utime;
  const std::vector<int64_t> known = knownSteps(log, life);
  int64_t first_step = begin;
  if (!known.empty() && known.front() > begin)
    first_step = known.front() - (known.front() - begin) / period * period;
  const int64_t late = lastMessageOf(log, life) - period;
  NodeReplay<learner::LearnerNode> replay(
      config, life.boot_id,
      [&](const LogEvent& event) {
        published.take(event, event.utime > late);
        published.events.push_back(event);
      },
      first_step);
  replay.node().resume(life.state, life.earlier);
  replay.setSchedule([&, next = size_t{0}](int64_t step) mutable {
    while (next < known.size() && known[next] < step - period / 2) ++next;
    const bool is_known = next < known.size() && known[next] <= step + period / 2;
    return is_known ? known[next++] : step;
  });
  for (size_t i = life.first_event; i < life.end_event; ++i) replay.play(log.events[i]);
  if (life.end_event == log.events.size()) replay.stepUntil(log.events.back().utime + kAfterwards);
}

Published replayed(const RobotLog& log, const std::vector<LearnerLife>& lives,
                   const learner::LearnerNodeConfig& config) {
  Published published;
  for (const LearnerLife& life : lives) playLife(log, life, config, published);
  return published;
}

/// Messages in the log from the start of the replay on.
Published publishedInLog(const RobotLog& log, const LearnerLife& first) {
  Published published;
  for (size_t i = first.first_event; i < log.events.size(); ++i) published.take(log.events[i]);
  if (!first.from_start)
    for (const ExecutionKey& key : first.state.handled) published.learned.erase(key);
  auto& sets = published.sets;
  sets.erase(sets.begin(), sets.lower_bound(first.state.set.version()));
  return published;
}

std::string partsDifference(const SetParts& log, const SetParts& replay, double tolerance) {
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

/// Versions that a newer one of the same parent replaced before they were sent: during an execution
/// a busy host's learner may finish several.
std::set<int64_t> overtaken(const Published& in_log, const Published& replay) {
  std::map<int64_t, int64_t> newest;  // by parent
  for (const auto& [version, parts] : in_log.sets)
    newest[parts.begin()->second.parent_version] = version;
  std::set<int64_t> versions;
  for (const auto& [version, parts] : replay.sets) {
    const auto sibling = newest.find(parts.begin()->second.parent_version);
    if (sibling != newest.end() && sibling->second > version) versions.insert(version);
  }
  return versions;
}

void compare(const RobotLog& log, const Published& in_log, const Published& replay,
             LearnerCheck& check) {
  const auto lost = [&log](const char* channel) {
    const auto missing = log.missing.find(channel);
    return missing == log.missing.end() ? 0 : missing->second;
  };
  const double tolerance = check.tolerance;
  std::set<int64_t> unsent = overtaken(in_log, replay);
  unsent.insert(replay.late_versions.begin(), replay.late_versions.end());
  check.versions = compareByKey(
      in_log.sets, replay.sets, unsent, lost(kPatternSet.name),
      [tolerance](const SetParts& a, const SetParts& b) {
        return partsDifference(a, b, tolerance);
      },
      [](int64_t version) { return "version " + std::to_string(version); }, check);
  check.learning = compareByKey(
      in_log.learned, replay.learned, replay.late_learned, lost(kLearning.name),
      [tolerance](const learning_t& a, const learning_t& b) {
        return differenceOf(a, b, tolerance);
      },
      [](const ExecutionKey& key) { return "LEARNING of execution " + std::to_string(key.second); },
      check);
  for (const auto& [key, learned] : replay.learned)
    if (learned.accepted) ++check.measured;
}

}  // namespace

bool LearnerCheck::equal() const {
  return same_twice && first_difference.empty() && versions.equal > 0;
}

LearnerCheck checkLearner(const RobotLog& log, const learner::LearnerNodeConfig& config) {
  const std::vector<LearnerLife> lives = learnerLives(log, config.shipped);
  LearnerCheck check;
  check.name = log.name;
  check.lives = static_cast<int>(lives.size());
  check.from_start = lives.front().from_start;
  check.tolerance = check.from_start ? 0.0 : kMiddleTolerance;
  const Published in_log = publishedInLog(log, lives.front());
  const Published first = replayed(log, lives, config);
  check.same_twice = sameBytes(first.events, replayed(log, lives, config).events);
  if (!in_log.sets.empty()) {
    check.first_version = in_log.sets.begin()->first;
    check.last_version = in_log.sets.rbegin()->first;
  }
  compare(log, in_log, first, check);
  check.noteLog(log, "learner");
  return check;
}

std::string reportOf(const LearnerCheck& check) {
  std::ostringstream out;
  out << check.name << ": " << check.lives << (check.lives == 1 ? " life" : " lives")
      << " of the learner, from "
      << (check.from_start ? "its start" : "the first state in the log (numbers compared to 1e-9)")
      << ", versions " << check.first_version << " to " << check.last_version << "\n"
      << notesText(check) << "  PATTERN_SET: " << countsText(check.versions, " versions")
      << "\n  LEARNING: " << countsText(check.learning, " executions") << ", which measured "
      << check.measured << "\n"
      << differenceText(check) << check.name << ": learner "
      << (check.equal() ? "EQUAL" : "DIFFERENT") << "\n";
  return out.str();
}

}  // namespace tread::replay
