// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <limits>
#include <stdexcept>
#include <string>
#include <vector>

#include "common/execution/measurement.hpp"
#include "common/pattern/pattern.hpp"
#include "tests/helpers.hpp"

namespace tread::learner::samples {

using tread::testing::kNan;

/// Ids of the patterns of smallSet().
enum Id { kStraight = 1, kLeft = 2, kRight = 3, kSpin = 4, kReverse = 5 };

/// Poses every `period` seconds of a motion with a constant body twist.
inline std::vector<Pose2> arc(const Twist2& twist, int samples = 20, double period = 0.05) {
  std::vector<Pose2> trajectory;
  for (int t = 1; t <= samples; ++t) trajectory.push_back(integrate(twist, t * period));
  return trajectory;
}

inline MotionPattern pattern(int id, const std::string& name, const TrackCommand& command,
                             std::vector<Pose2> trajectory) {
  MotionPattern made;
  made.id = id;
  made.name = name;
  made.entry_class = made.exit_class = "cruise";
  made.commands.assign(trajectory.size(), command);
  made.trajectory = std::move(trajectory);
  return made;
}

inline PatternSet checked(PatternSetContent content) {
  std::string why;
  const auto set = PatternSet::make(std::move(content), why);
  if (!set) throw std::invalid_argument(why);
  return *set;
}

/// Straight, left, right, in-place turn and reverse of one second, all from cruise to cruise.
inline PatternSetContent smallContent() {
  PatternSetContent content;
  content.name = "small";
  content.classes = {{"cruise", {1.0, 0.0, 0.0}, {1.0, 1.0}}};
  content.patterns = {
      pattern(kStraight, "straight", {1.0, 1.0}, arc({1.0, 0.0, 0.0})),
      pattern(kLeft, "left", {0.7, 1.0}, arc({0.9, 0.0, 0.5})),
      pattern(kRight, "right", {1.0, 0.7}, arc({0.9, 0.0, -0.5})),
      pattern(kSpin, "spin", {-0.6, 0.6}, arc({0.0, 0.0, 1.2})),
      pattern(kReverse, "reverse", {-1.0, -1.0}, arc({-0.8, 0.0, 0.0})),
  };
  return content;
}

inline PatternSet smallSet() {
  return checked(smallContent());
}

/// A valid, complete measurement with this trajectory.
inline Measurement fair(std::vector<Pose2> trajectory) {
  Measurement measurement;
  measurement.covered = trajectory.size();
  measurement.trajectory = std::move(trajectory);
  return measurement;
}

}  // namespace tread::learner::samples
