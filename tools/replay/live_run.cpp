// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/replay/live_run.hpp"

#include <map>
#include <sstream>

#include "tools/replay/set_difference.hpp"

namespace tread::replay {
namespace {

std::map<ExecutionKey, learning_t> learnedIn(const RobotLog& run) {
  std::map<ExecutionKey, learning_t> learned;
  for (const TimedEvent& timed : run.events) {
    learning_t message;
    if (decode(timed.event, kLearning, message))
      learned.emplace(ExecutionKey{message.learned_run_id, message.learned_execution_id}, message);
  }
  return learned;
}

void takeHealth(const RobotLog& run, LiveComparison& comparison) {
  for (const TimedEvent& timed : run.events) {
    health_t health;
    if (!decode(timed.event, kHealth, health) || health.process != "learner") continue;
    comparison.heard = health.received;
    comparison.lost = health.lost;
  }
}

}  // namespace

LiveComparison compareLive(const RobotLog& run, const DriveLog& played,
                           const LearnerRun& virtual_run) {
  LiveComparison comparison;
  comparison.name = run.name;
  comparison.played = static_cast<int64_t>(played.events.size());
  takeHealth(run, comparison);
  const std::map<ExecutionKey, learning_t> live = learnedIn(run);
  for (const learning_t& expected : virtual_run.learned) {
    ++comparison.executions;
    if (expected.accepted) ++comparison.accepted;
    const auto found = live.find({expected.learned_run_id, expected.learned_execution_id});
    std::string difference =
        "LEARNING of execution " + std::to_string(expected.learned_execution_id) + ": none";
    if (found != live.end()) {
      ++comparison.reported;
      learning_t actual = found->second;
      if (actual.accepted) ++comparison.accepted_live;
      actual.result_version = expected.result_version;
      difference = differenceOf(expected, actual);
    }
    if (difference.empty()) ++comparison.equal;
    if (comparison.first_difference.empty()) comparison.first_difference = difference;
  }
  return comparison;
}

std::string reportOf(const LiveComparison& c) {
  std::ostringstream out;
  out << c.name << ": the running learner heard " << c.heard << " of " << c.played
      << " messages, knows of " << c.lost << " lost; reported " << c.reported << " of "
      << c.executions << " executions, measured " << c.accepted_live << " of " << c.accepted << ", "
      << c.equal << " reports equal to the virtual replay\n";
  if (!c.first_difference.empty())
    out << "  first difference (log = virtual, replay = running): " << c.first_difference << "\n";
  return out.str();
}

}  // namespace tread::replay
