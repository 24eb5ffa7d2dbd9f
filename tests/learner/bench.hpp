// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <map>
#include <memory>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/bus/virtual_bus.hpp"
#include "common/store/store.hpp"
#include "modules/learner/learner_node.hpp"
#include "tests/learner/fake_robot.hpp"

namespace tread::learner::samples {

/// A learner and a fake robot on a virtual bus, with subscriptions to all of the learner's
/// channels.
struct Bench {
  explicit Bench(Driving driving = {}, Rule rule = "collective", FaultPlan faults = {},
                 uint64_t seed = 1, int64_t follow_us = 400'000)
      : bus(seed, std::move(faults)), config(smallSet()) {
    config.rule.rule = rule;
    config.follow_us = follow_us;
    config.rule.memory = 0.3;
    config.limits.entry_yaw_rate = 0.7;
    Bus& ear = bus.outside();
    ear.subscribe<learning_t>(kLearning, [this](const learning_t& m) { learned.push_back(m); });
    ear.subscribe<health_t>(kHealth, [this](const health_t& m) { health = m; });
    ear.subscribe<learner_state_t>(kLearnerState,
                                   [this](const learner_state_t& m) { states.push_back(m); });
    ear.subscribe<pattern_set_part_t>(kPatternSet, [this](const pattern_set_part_t& part) {
      versions.push_back(part.set_version);
      parts[part.set_version][part.set_pattern_id] = part;
    });
    bus.addNode("learner",
                [this](Bus& end) { return std::make_unique<LearnerNode>(config, end, store); });
    bus.addNode("robot", [driving](Bus& end) { return std::make_unique<FakeRobot>(end, driving); });
  }

  void run(double seconds) { bus.runUntil(bus.now() + static_cast<int64_t>(seconds * 1e6)); }
  LearnerNode& node() { return *static_cast<LearnerNode*>(bus.node("learner")); }
  int64_t counter(const std::string& name) const {
    for (const counter_t& counter : health.counters)
      if (counter.counter_name == name) return counter.counted;
    return 0;
  }
  /// The pattern with this id in the newest completely published version.
  const pattern_set_part_t& published(int id) const {
    for (auto version = parts.rbegin(); version != parts.rend(); ++version)
      if (static_cast<int32_t>(version->second.size()) ==
          version->second.begin()->second.part_count)
        return version->second.at(id);
    throw std::logic_error("no set was published whole");
  }
  double publishedYaw(int id) const { return published(id).trajectory.back()[2]; }
  bool versionsNeverWentBack() const {
    for (size_t i = 1; i < versions.size(); ++i)
      if (versions[i] < versions[i - 1]) return false;
    return true;
  }

  MemoryStore store;
  VirtualBus bus;
  LearnerNodeConfig config;
  std::vector<learning_t> learned;
  std::vector<learner_state_t> states;
  std::vector<int64_t> versions;
  std::map<int64_t, std::map<int, pattern_set_part_t>> parts;  ///< by version and pattern id
  health_t health{};
};

/// Whether two sets predict the same, bit for bit.
inline bool samePredictions(const PatternSet& a, const PatternSet& b) {
  for (const MotionPattern& pattern : a.patterns()) {
    const MotionPattern& other = *b.find(pattern.id);
    for (size_t t = 0; t < pattern.trajectory.size(); ++t)
      if (pattern.trajectory[t].x != other.trajectory[t].x ||
          pattern.trajectory[t].y != other.trajectory[t].y ||
          pattern.trajectory[t].yaw != other.trajectory[t].yaw)
        return false;
  }
  return true;
}

}  // namespace tread::learner::samples
