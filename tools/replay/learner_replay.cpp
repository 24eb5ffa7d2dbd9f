// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/replay/learner_replay.hpp"

#include <algorithm>

#include "common/bus/virtual_bus.hpp"

namespace tread::replay {
namespace {

constexpr int64_t kSecond = 1'000'000;
constexpr const char* kNode = "learner";

/// Plays the events of a log and writes into EXECUTION the versions that this learner had
/// published.
class Player {
 public:
  Player(VirtualBus& bus, Commitment commitment) : bus_(bus), commitment_(commitment) {}

  void play(const LogEvent& event) {
    bus_.runUntil(std::max(bus_.now(), event.utime));
    if (event.channel != kExecution.name)
      return bus_.inject(event.channel.c_str(), event.bytes.data(), event.bytes.size());
    execution_t message;
    if (!decode(event, kExecution, message)) return;
    for (execution_record_t& record : message.records)
      record.record_set_version = versionFor(record);
    bus_.outside().publish(kExecution, message);
  }

 private:
  int64_t versionFor(const execution_record_t& record) {
    const int64_t newest =
        static_cast<const learner::LearnerNode*>(bus_.node(kNode))->set().version();
    const bool running = record.outcome == execution_record_t::OUTCOME_RUNNING;
    const ExecutionKey key = keyOf(record);
    if (commitment_ == Commitment::kPrompt && running) return newest;
    return versions_.emplace(key, newest).first->second;
  }

  VirtualBus& bus_;
  Commitment commitment_;
  std::map<ExecutionKey, int64_t> versions_;
};

}  // namespace

LearnerRun runLearner(const DriveLog& log, const learner::LearnerNodeConfig& config,
                      Commitment commitment, const std::string& title) {
  LearnerRun run;
  run.title = title;
  if (log.events.empty()) return run;
  MemoryStore store;
  VirtualBus bus(1, {}, std::max<int64_t>(1, log.events.front().utime - kSecond));
  bus.outside().subscribe<learning_t>(
      kLearning, [&run](const learning_t& learned) { run.learned.push_back(learned); });
  bus.outside().subscribe<health_t>(kHealth, [&run](const health_t& health) {
    run.health = health.health_reason;
    for (const counter_t& counter : health.counters)
      run.counters[counter.counter_name] = counter.counted;
  });
  bus.addNode(kNode,
              [&](Bus& end) { return std::make_unique<learner::LearnerNode>(config, end, store); });
  Player player(bus, commitment);
  for (const LogEvent& event : log.events) player.play(event);
  // Executions without INS at their end are given up after a while; HEALTH follows within a second.
  bus.runUntil(bus.now() + config.settle_us + config.give_up_us + 2 * kSecond);
  return run;
}

}  // namespace tread::replay
