// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>

#include "tools/lab/experiment/tables.hpp"
#include "tools/lab/experiment/trials.hpp"

namespace tread::experiment::testing {

inline const std::string kWorlds = std::string(TREAD_SOURCE_DIR) + "/config/worlds/";

/// Two surfaces, three patterns of ten samples.
inline const char* const kSmallWorld = R"(kind: transitions
name: small
vehicle: {full_speed: 1.1, gauge: 0.6, lag: 0.15}
recordings: 40
noise: {position: 0.003, yaw: 0.001}
sequences:
  - patterns: [left, left, right]
  - patterns: [right, right, left]
patterns:
  - {name: straight, commands: [[1, 1, 10]]}
  - {name: left, commands: [[0.7, 1, 10]]}
  - {name: right, commands: [[1, 0.7, 10]]}
surfaces:
  - name: ice
    forward_gain: 1.1
    yaw_gain: 0.6
    spread: {forward: 0.03, yaw: 0.06, crab: 0.03}
  - name: road
    yaw_gain: 1.0
    spread: {forward: 0.01, yaw: 0.03, crab: 0.01}
)";

inline std::vector<TrialGround> groundsOfText(const std::string& text, uint64_t seed = 1) {
  std::vector<std::string> notes;
  return groundsOf(record(parseTransitionWorld(text, "small.yaml"), seed), notes);
}

/// Settings for the small world: left, left, right and the reverse.
inline ExperimentSettings smallSettings() {
  ExperimentSettings settings;
  settings.rules = {"off", "single", "collective", "telescoping", kOmniscient};
  settings.sequences = {{1, 1, 2}, {2, 2, 1}};
  settings.repetitions = 600;
  settings.excitation = 40;
  return settings;
}

}  // namespace tread::experiment::testing
