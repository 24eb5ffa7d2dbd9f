// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/patterns/advice.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <set>

#include "tools/patterns/mirror.hpp"

namespace tread::patterns {
namespace {

constexpr double kSpeedOff = 0.15;  // [m/s] at the end; a third of what the learner's gate allows
constexpr double kTurnOff = 0.20;   // [rad/s]
constexpr double kShareOff = 0.10;  // [1] of the class's own speed or rate, if that is more
constexpr double kEndSpan = 0.1;    // [s] over which the twist at the end is taken

template <typename... Values>
std::string line(const char* format, Values... values) {
  std::array<char, 320> text{};
  std::snprintf(text.data(), text.size(), format, values...);
  return text.data();
}

bool stands(const MotionClass& motion) {
  return motion.steady.left == 0.0 && motion.steady.right == 0.0;
}

/// Classes that chains of patterns reach from these, or that reach these when `backwards`.
std::set<std::string> connected(const PatternSet& set, std::set<std::string> found,
                                bool backwards) {
  for (size_t before = 0; before != found.size();) {
    before = found.size();
    for (const MotionPattern& pattern : set.patterns()) {
      const std::string& from = backwards ? pattern.exit_class : pattern.entry_class;
      const std::string& to = backwards ? pattern.entry_class : pattern.exit_class;
      if (found.count(from) > 0) found.insert(to);
    }
  }
  return found;
}

void adviseClasses(const PatternSet& set, std::vector<std::string>& advice) {
  std::set<std::string> standing;
  for (const MotionClass& motion : set.content().classes)
    if (stands(motion)) standing.insert(motion.name);
  if (standing.empty()) {
    advice.push_back(
        "no class stands still (steady command 0, 0): a robot can neither begin nor end with this "
        "set");
    return;
  }
  const std::set<std::string> reached = connected(set, standing, false);
  const std::set<std::string> left = connected(set, standing, true);
  for (const MotionClass& motion : set.content().classes) {
    if (reached.count(motion.name) == 0)
      advice.push_back(
          line("class '%s' cannot be reached from standing: no chain of patterns leads into it",
               motion.name.c_str()));
    if (left.count(motion.name) == 0)
      advice.push_back(line("class '%s' cannot be left: no chain of patterns leads to standing",
                            motion.name.c_str()));
  }
}

void advisePartner(const PatternSet& set, const MotionPattern& pattern,
                   std::vector<std::string>& advice) {
  if (turns(pattern) && mirrorPartner(set, pattern) == nullptr)
    advice.push_back(line("pattern '%s' has no mirror image; add it with tread-patterns mirror",
                          pattern.name.c_str()));
}

/// Mean twist over the last kEndSpan of a trajectory.
Twist2 twistAtEnd(const MotionPattern& pattern, double period) {
  const size_t count = pattern.trajectory.size();
  const auto wanted = static_cast<size_t>(std::max(1.0, std::round(kEndSpan / period)));
  const size_t span = std::min(wanted, count);
  const Pose2 before = span < count ? pattern.trajectory[count - 1 - span] : Pose2{};
  return twistTo(between(before, pattern.end()), static_cast<double>(span) * period);
}

void adviseEnd(const PatternSet& set, const MotionPattern& pattern,
               std::vector<std::string>& advice) {
  const Twist2 end = twistAtEnd(pattern, set.periodSeconds());
  const Twist2& wanted = set.classNamed(pattern.exit_class).twist;
  const double speed_off = std::hypot(end.v_x - wanted.v_x, end.v_y - wanted.v_y);
  const double turn_off = std::abs(end.omega - wanted.omega);
  const double speed_limit = std::max(kSpeedOff, kShareOff * std::hypot(wanted.v_x, wanted.v_y));
  const double turn_limit = std::max(kTurnOff, kShareOff * std::abs(wanted.omega));
  if (speed_off <= speed_limit && turn_off <= turn_limit) return;
  advice.push_back(line(
      "pattern '%s' ends with %.2f m/s, %.2f m/s to the left and %.2f rad/s; its exit class '%s' "
      "has %.2f, %.2f and %.2f: what follows begins otherwise than it was predicted",
      pattern.name.c_str(), end.v_x, end.v_y, end.omega, pattern.exit_class.c_str(), wanted.v_x,
      wanted.v_y, wanted.omega));
}

void adviseCovariances(const PatternSet& set, std::vector<std::string>& advice) {
  std::string names;
  size_t unknown = 0;
  for (const MotionPattern& pattern : set.patterns()) {
    if (!std::isnan(pattern.end_covariance[0])) continue;
    ++unknown;
    names += (names.empty() ? "'" : ", '") + pattern.name + "'";
  }
  if (unknown == set.patterns().size()) names = "all patterns";
  if (unknown > 0) advice.push_back("unknown end covariance of " + names);
}

}  // namespace

std::vector<std::string> adviceFor(const PatternSet& set) {
  std::vector<std::string> advice;
  adviseClasses(set, advice);
  for (const MotionPattern& pattern : set.patterns()) {
    advisePartner(set, pattern, advice);
    adviseEnd(set, pattern, advice);
  }
  adviseCovariances(set, advice);
  return advice;
}

}  // namespace tread::patterns
