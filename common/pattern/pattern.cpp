// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/pattern/pattern.hpp"

#include <cmath>
#include <stdexcept>
#include <utility>

#include "common/pattern/pattern_check.hpp"
#include "common/pattern/pattern_checksum.hpp"

namespace tread {

double MotionPattern::pathLength() const {
  double length = 0.0;
  Pose2 last;
  for (const Pose2& pose : trajectory) {
    length += std::hypot(pose.x - last.x, pose.y - last.y);
    last = pose;
  }
  return length;
}

std::optional<PatternSet> PatternSet::make(PatternSetContent content, std::string& why) {
  why.clear();
  if (const auto problem = firstProblem(content)) {
    why = problem->line(content);
    return std::nullopt;
  }
  const int64_t checksum = checksumOf(content);
  return PatternSet(std::make_shared<const PatternSetContent>(std::move(content)), checksum);
}

const MotionPattern* PatternSet::find(int id) const {
  for (const MotionPattern& pattern : patterns())
    if (pattern.id == id) return &pattern;
  return nullptr;
}

const MotionPattern* PatternSet::findByName(const std::string& name) const {
  for (const MotionPattern& pattern : patterns())
    if (pattern.name == name) return &pattern;
  return nullptr;
}

const MotionClass& PatternSet::classNamed(const std::string& name) const {
  for (const MotionClass& motion : content_->classes)
    if (motion.name == name) return motion;
  throw std::out_of_range("pattern set '" + content_->name + "' has no motion class '" + name +
                          "'");
}

bool PatternSet::joinable(const MotionPattern& previous, const MotionPattern& next) const {
  return previous.exit_class == next.entry_class;
}

std::vector<const MotionPattern*> PatternSet::startingIn(const std::string& entry_class) const {
  std::vector<const MotionPattern*> starting;
  for (const MotionPattern& pattern : patterns())
    if (pattern.entry_class == entry_class) starting.push_back(&pattern);
  return starting;
}

}  // namespace tread
