// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "common/config/config_reader.hpp"
#include "modules/learner/core/learner.hpp"

namespace tread::learner {

/// Configuration of the learner process; the shell reads the shipped set from its file.
struct LearnerNodeConfig {
  PatternSet shipped;  ///< where learning begins
  RuleConfig rule;
  MeasurementLimits limits;
  int64_t period_us = 20'000;  ///< [us] between steps
  int64_t settle_us =
      200'000;  ///< [us] what is this old has arrived: INS latency and disorder of the bus
  int64_t give_up_us =
      2'000'000;  ///< [us] after its end: an execution is then measured with the INS there is
  int64_t repeat_us = 2'000'000;       ///< [us] between repetitions of the set
  int64_t track_span_us = 60'000'000;  ///< [us] of INS that is kept
  int64_t remembered_versions = 50;    ///< sets kept to score executions with the version they name

  std::string store = "state/learner";  ///< folder of the state; used by the process

  explicit LearnerNodeConfig(PatternSet set) : shipped(std::move(set)) {}
  /// The configuration with its defaults, for CONFIG.
  std::string effective() const;
};

/// Reads the configuration and the pattern file that it names; throws ConfigError with file:line.
LearnerNodeConfig readLearnerConfig(ConfigReader& reader);

/// Reads everything but the pattern file, over what `config` holds; does not finish() the reader.
void readLearnerSettings(ConfigReader& reader, LearnerNodeConfig& config);

}  // namespace tread::learner
