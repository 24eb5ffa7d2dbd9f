// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/pattern/pattern.hpp"

namespace tread::testing {

/// A small valid set: start (rest to cruise), left (cruise), stop (cruise to rest).
inline PatternSetContent goodContent() {
  PatternSetContent content;
  content.name = "sample";
  content.version = 7;
  content.parent_version = 6;
  content.utime = 123'456'789;
  content.classes = {{"rest", {}, {}}, {"cruise", {1.0, 0.0, 0.0}, {1.0, 1.0}}};
  MotionPattern start;
  start.id = 1;
  start.name = "start";
  start.entry_class = "rest";
  start.exit_class = "cruise";
  start.commands = {{1.0, 1.0}, {1.0, 1.0}};
  start.trajectory = {{0.01, 0.0, 0.0}, {0.05, 0.0, 0.0}};
  MotionPattern left;
  left.id = 2;
  left.name = "left";
  left.entry_class = left.exit_class = "cruise";
  left.commands = {{0.8, 1.0}, {0.8, 1.0}, {1.0, 1.0}};
  left.trajectory = {{0.05, 0.0, 0.01}, {0.1, 0.001, 0.03}, {0.15, 0.004, 0.04}};
  left.end_covariance = {1e-4, 1e-6, -2e-6, 4e-4, 3e-5, 9e-4};
  left.times_learned = 3;
  MotionPattern stop;
  stop.id = 3;
  stop.name = "stop";
  stop.entry_class = "cruise";
  stop.exit_class = "rest";
  stop.commands = {{0.0, 0.0}};
  stop.trajectory = {{0.02, 0.0, 0.0}};
  content.patterns = {start, left, stop};
  return content;
}

/// The same for a vehicle with throttle, front and rear steering.
inline PatternSetContent threeChannels() {
  PatternSetContent content = goodContent();
  content.channels = {{"throttle", CommandKind::kPower, -0.5, 1.0},
                      {"steering", CommandKind::kSteeringAngle, -0.4, 0.4},
                      {"rear steering", CommandKind::kSteeringAngle, -0.2, 0.2}};
  content.classes[1].steady = {0.8, 0.1};
  for (MotionPattern& pattern : content.patterns)
    for (size_t i = 0; i < pattern.commands.size(); ++i) {
      pattern.commands[i] = {0.25 * static_cast<double>(i), 0.375 - 0.125 * static_cast<double>(i)};
      pattern.commands[i][2] = -0.2;
    }
  return content;
}

}  // namespace tread::testing
