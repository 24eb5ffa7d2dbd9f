// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/learner_config.hpp"

#include <cmath>
#include <limits>

#include "common/config/config_reader.hpp"
#include "common/pattern/pattern_file.hpp"
#include "common/vehicle/robot_description.hpp"

namespace tread::learner {
namespace {

void readGates(ConfigReader& reader, MeasurementLimits& limits) {
  ConfigReader gates = reader.section("gates");
  gates.seconds("max_gap", limits.max_gap_us, {0.01, 5.0});
  gates.number("min_covered", limits.min_covered, {0.1, 1.0}, "1");
  gates.number("max_speed", limits.max_speed, {0.0, 20.0}, "m/s");
  gates.number("speed_margin", limits.speed_margin, {1.0, 10.0}, "1");
  gates.number("min_motion", limits.min_motion, {0.0, 1.0}, "m");
  gates.number("min_turn", limits.min_turn, {0.0, 1.0}, "rad");
  gates.seconds("entry_window", limits.entry_window_us, {0.01, 2.0});
  gates.number("entry_speed", limits.entry_speed, {0.01, 40.0}, "m/s");
  gates.number("entry_yaw_rate", limits.entry_yaw_rate, {0.01, 40.0}, "rad/s");
  // A file cannot say "infinite".
  bool any_entry = std::isinf(limits.entry_speed) && std::isinf(limits.entry_yaw_rate);
  gates.flag("any_entry", any_entry);
  if (any_entry)
    limits.entry_speed = limits.entry_yaw_rate = std::numeric_limits<double>::infinity();
  gates.number("max_slope", limits.max_slope, {0.0, 1.6}, "rad");
}

}  // namespace

LearnerNodeConfig readLearnerConfig(ConfigReader& reader) {
  std::string patterns;
  reader.path("patterns", patterns, true);
  LearnerNodeConfig config(readPatternFile(patterns));
  if (reader.has("robot"))
    config.limits.max_slope = readRobot(reader).max_tilt.value_or(config.limits.max_slope);
  readLearnerSettings(reader, config);
  reader.finish();
  return config;
}

void readLearnerSettings(ConfigReader& reader, LearnerNodeConfig& config) {
  reader.text("store", config.store);
  std::string rule = config.rule.rule;
  reader.choice("rule", rule, ruleNames());
  config.rule.rule = rule;
  // w = 1 would never learn and never say why: `off` is the word for that.
  reader.number("memory", config.rule.memory, {0.0, 0.999}, "1");
  readRules(reader, config.rule);
  readGates(reader, config.limits);
  // Not shorter: the publisher sends a portion a step, and LCM loses more than 100 kB in 20 ms.
  reader.seconds("period", config.period_us, {0.02, 0.1});
  reader.seconds("settle", config.settle_us, {0.0, 2.0});
  reader.seconds("give_up", config.give_up_us, {0.1, 30.0});
  reader.seconds("repeat", config.repeat_us, {0.2, 5.0});
  reader.seconds("track_span", config.track_span_us, {5.0, 600.0});
  reader.integer("remembered_versions", config.remembered_versions, {2, 1000}, "1");
}

std::string LearnerNodeConfig::effective() const {
  // Reading nothing over these values writes them.
  ConfigReader reader = ConfigReader::fromText("{}", "learner");
  LearnerNodeConfig copy = *this;
  readLearnerSettings(reader, copy);
  return "shipped_set: " + shipped.content().name +
         "\nshipped_checksum: " + std::to_string(shipped.checksum()) + "\n" + reader.effective();
}

}  // namespace tread::learner
