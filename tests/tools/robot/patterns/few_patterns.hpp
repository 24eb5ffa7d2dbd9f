// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/pattern/pattern.hpp"

namespace tread::patterns::kit {

/// A pattern of ten samples with one twist; `commands` are held throughout.
inline MotionPattern pattern(int id, const std::string& name, const TrackCommand& command,
                             const Twist2& twist, const std::string& entry = "cruise",
                             const std::string& exit = "cruise") {
  MotionPattern made;
  made.id = id;
  made.name = name;
  made.entry_class = entry;
  made.exit_class = exit;
  made.commands.assign(10, command);
  for (int t = 1; t <= 10; ++t) made.trajectory.push_back(integrate(twist, 0.1 * t));
  made.end_covariance = {1e-4, 2e-5, 3e-5, 4e-4, 5e-5, 6e-4};
  return made;
}

inline PatternSet setOf(std::vector<MotionPattern> patterns, bool rest = false) {
  PatternSetContent content;
  content.name = "few";
  content.period_us = 100'000;
  content.classes = {{"cruise", {0.5, 0.0, 0.0}, {0.5, 0.5}}};
  if (rest) content.classes.push_back({"rest", {}, {}});
  content.patterns = std::move(patterns);
  std::string why;
  return PatternSet::make(std::move(content), why).value();
}

/// start, straight, left and stop: without the mirror image of left.
inline PatternSet withoutRight() {
  return setOf({pattern(1, "straight", {0.5, 0.5}, {0.5, 0.0, 0.0}),
                pattern(2, "left", {0.4, 0.5}, {0.5, 0.01, 0.1}),
                pattern(3, "start", {0.5, 0.5}, {0.5, 0.0, 0.0}, "rest", "cruise"),
                pattern(4, "stop", {0.0, 0.0}, {0.0, 0.0, 0.0}, "cruise", "rest")},
               true);
}

}  // namespace tread::patterns::kit
