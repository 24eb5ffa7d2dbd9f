// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <optional>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "common/pattern/pattern.hpp"
#include "common/recordings/recordings.hpp"

namespace tread::recordings::samples {

/// A temporary folder.
class Folder {
 public:
  Folder() {
    static int count = 0;
    path_ = std::filesystem::temp_directory_path() /
            ("tread-recordings-" + std::to_string(getpid()) + "-" + std::to_string(++count));
    std::filesystem::create_directories(path_);
  }
  ~Folder() { std::filesystem::remove_all(path_); }
  Folder(const Folder&) = delete;
  Folder& operator=(const Folder&) = delete;

  std::string path(const std::string& name = "") const { return (path_ / name).string(); }
  void write(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
  }

 private:
  std::filesystem::path path_;
};

/// Poses of a constant twist, one per period.
inline std::vector<Pose2> arc(const Twist2& twist, size_t samples, double period = 0.1) {
  std::vector<Pose2> poses;
  for (size_t t = 1; t <= samples; ++t)
    poses.push_back(integrate(twist, static_cast<double>(t) * period));
  return poses;
}

inline MotionPattern pattern(int id, const std::string& name, const Twist2& twist, size_t samples) {
  MotionPattern made;
  made.id = id;
  made.name = name;
  made.entry_class = made.exit_class = "cruise";
  made.commands.assign(samples, {0.5, 0.5});
  made.trajectory = arc(twist, samples);
  return made;
}

inline PatternSet setOf(std::vector<MotionPattern> patterns) {
  PatternSetContent content;
  content.name = "few";
  content.period_us = 100'000;
  content.classes = {{"cruise", {0.5, 0.0, 0.0}, {0.5, 0.5}}};
  content.patterns = std::move(patterns);
  std::string why;
  return PatternSet::make(std::move(content), why).value();
}

/// Patterns straight and left with three samples each.
inline PatternSet twoPatterns() {
  return setOf(
      {pattern(1, "straight", {0.5, 0.0, 0.0}, 3), pattern(2, "left", {0.5, 0.0, 0.4}, 3)});
}

/// `count` executions of each pattern, with twists scattered by 5 % and 0.02 rad/s.
inline SurfaceRecordings scattered(const PatternSet& set, const std::string& surface, int count,
                                   unsigned seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  SurfaceRecordings recordings{surface, {}};
  for (const MotionPattern& each : set.patterns()) {
    const Twist2 twist = twistTo(each.end(), static_cast<double>(each.commands.size()) * 0.1);
    std::vector<Execution> executions;
    for (int e = 0; e < count; ++e) {
      const double gain = 1.0 + 0.05 * normal(random);
      const double omega = twist.omega + 0.02 * normal(random);
      executions.push_back(arc({gain * twist.v_x, 0.0, omega}, each.commands.size()));
    }
    recordings.executions.push_back(std::move(executions));
  }
  return recordings;
}

/// Finite poses that are equal bitwise.
inline bool same(const Execution& a, const Execution& b) {
  if (a.size() != b.size()) return false;
  for (size_t t = 0; t < a.size(); ++t)
    if (a[t].x != b[t].x || a[t].y != b[t].y || a[t].yaw != b[t].yaw) return false;
  return true;
}

}  // namespace tread::recordings::samples
