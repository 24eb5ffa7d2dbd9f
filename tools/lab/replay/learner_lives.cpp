// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/replay/learner_lives.hpp"

#include <set>
#include <stdexcept>

#include "common/messages/pattern_messages.hpp"
#include "modules/learner/core/state_text.hpp"
#include "tools/lab/replay/robot_replay.hpp"

namespace tread::replay {
namespace {

/// Longest time from a process's start to its first message [us].
constexpr int64_t kLongestStart = 10'000'000;

/// A complete LEARNER_STATE.
struct Snapshot {
  size_t event = 0;  ///< index of its last part
  int64_t seq = 0;   ///< of its first part
  std::string text;
};

/// States with all parts in the log.
std::vector<Snapshot> snapshotsOf(const RobotLog& log) {
  std::vector<Snapshot> whole;
  Snapshot current;
  int32_t next = -1;
  for (size_t i = 0; i < log.events.size(); ++i) {
    learner_state_t part;
    if (!decode(log.events[i], kLearnerState, part)) continue;
    if (part.state_part == 0) {
      current = {i, part.seq, {}};
      next = 0;
    }
    if (part.state_part != next) continue;
    current.text.append(part.state_bytes.begin(), part.state_bytes.end());
    current.event = i;
    if (++next == part.state_part_count) whole.push_back(current);
  }
  return whole;
}

/// The first state of each life: seq restarts with each start.
std::vector<Snapshot> beginningsOf(const std::vector<Snapshot>& snapshots) {
  std::vector<Snapshot> beginnings;
  int64_t last_seq = -1;
  for (const Snapshot& snapshot : snapshots) {
    if (beginnings.empty() || snapshot.seq <= last_seq) beginnings.push_back(snapshot);
    last_seq = snapshot.seq;
  }
  return beginnings;
}

/// Boot id of the learner at an event: from its next HEALTH, else from the previous one.
int64_t bootIdAt(const RobotLog& log, size_t event) {
  const std::vector<Said<health_t>>& health = log.healthOf("learner");
  if (health.empty()) return log.events[event].utime;
  const auto next = notesBetween(health, event, log.events.size()).first;
  return (next == health.end() ? health.back() : *next).message.boot_id;
}

/// First event received by a process that was started at `boot_id`.
size_t firstHeard(const RobotLog& log, size_t before, int64_t boot_id) {
  const int64_t published = log.events[before].utime;
  if (boot_id > published || published - boot_id > kLongestStart) return before;
  size_t first = before;
  while (first > 0 && log.events[first - 1].utime >= boot_id) --first;
  return first;
}

std::vector<PatternSet> setsBefore(const RobotLog& log, size_t end, int64_t version) {
  std::vector<PatternSet> sets;
  PatternSetAssembler assembler;
  for (size_t i = 0; i < end; ++i) {
    pattern_set_part_t part;
    if (!decode(log.events[i], kPatternSet, part)) continue;
    auto set = assembler.add(part);
    if (set && set->version() < version) sets.push_back(*set);
  }
  return sets;
}

/// A start renumbers the stored set; running executions still name the old number.
std::vector<PatternSet> storedSet(const PatternSet& renumbered) {
  PatternSetContent content = renumbered.content();
  if (content.parent_version < 1) return {};
  content.version = content.parent_version;
  content.parent_version = 0;
  std::string why;
  const auto set = PatternSet::make(std::move(content), why);
  return set ? std::vector<PatternSet>{*set} : std::vector<PatternSet>{};
}

LearnerLife lifeOf(const RobotLog& log, const Snapshot& snapshot, const PatternSet& shipped) {
  std::string why;
  auto state = learner::parseState(snapshot.text, shipped, why);
  if (!state) throw std::runtime_error(log.name + ": LEARNER_STATE " + why);
  const int64_t boot_id = bootIdAt(log, snapshot.event);
  const bool from_start = snapshot.seq == 0;
  const int64_t version = state->set.version();
  LearnerLife life{0, log.events.size(), boot_id, from_start, std::move(*state), {}};
  if (from_start) life.first_event = firstHeard(log, snapshot.event, boot_id);
  life.earlier = from_start ? storedSet(life.state.set) : setsBefore(log, snapshot.event, version);
  return life;
}

/// Whether a life can be replayed from its state: every execution to be handled must name a set in
/// the log, else it could not be scored.
bool namesKnownSets(const RobotLog& log, const LearnerLife& life) {
  std::set<int64_t> known;
  for (const PatternSet& set : life.earlier) known.insert(set.version());
  const std::set<ExecutionKey> handled(life.state.handled.begin(), life.state.handled.end());
  for (const LogEvent& event : log.events) {
    execution_t message;
    if (!decode(event, kExecution, message)) continue;
    for (const execution_record_t& record : message.records) {
      const ExecutionKey key = keyOf(record);
      const bool is_known = known.count(record.record_set_version) > 0 ||
                            record.record_set_version >= life.state.set.version();
      if (!is_known && handled.count(key) == 0) return false;
    }
  }
  return true;
}

/// For a log that begins in the middle of a life: the first state from which everything can be
/// replayed; the first of all if there is none.
std::vector<Snapshot> fromReplayable(const RobotLog& log, std::vector<Snapshot> snapshots,
                                     const PatternSet& shipped) {
  for (size_t i = 0; i < snapshots.size() && snapshots[i].seq > 0; ++i) {
    if (i > 0 && snapshots[i].seq <= snapshots[i - 1].seq) break;
    if (!namesKnownSets(log, lifeOf(log, snapshots[i], shipped))) continue;
    snapshots.erase(snapshots.begin(), snapshots.begin() + static_cast<std::ptrdiff_t>(i));
    break;
  }
  return snapshots;
}

}  // namespace

std::vector<LearnerLife> learnerLives(const RobotLog& log, const PatternSet& shipped) {
  std::vector<LearnerLife> lives;
  for (const Snapshot& snapshot : beginningsOf(fromReplayable(log, snapshotsOf(log), shipped))) {
    LearnerLife life = lifeOf(log, snapshot, shipped);
    if (!lives.empty()) lives.back().end_event = life.first_event;
    lives.push_back(std::move(life));
  }
  if (lives.empty())
    throw std::runtime_error(
        log.name +
        ": no complete LEARNER_STATE, so the learner's initial state is unknown; record from its "
        "start, or use --model or --patterns for a log without a learner");
  return lives;
}

}  // namespace tread::replay
