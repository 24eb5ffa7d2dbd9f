// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/patterns/table.hpp"

#include <array>
#include <cmath>
#include <cstdio>

namespace tread::patterns {
namespace {

constexpr double kDegrees = 180.0 / kPi;

template <typename... Values>
std::string line(const char* format, Values... values) {
  std::array<char, 256> text{};
  std::snprintf(text.data(), text.size(), format, values...);
  return text.data();
}

std::string spread(const PoseCovariance& covariance) {
  if (std::isnan(covariance[0])) return "unknown";
  return line("%.3f %.3f %4.1f", std::sqrt(covariance[0]), std::sqrt(covariance[3]),
              std::sqrt(covariance[5]) * kDegrees);
}

std::string row(const MotionPattern& pattern, double period) {
  const Pose2& end = pattern.end();
  return line("%4d  %-16s %-8s %-8s %5.2f %7.3f  %7.3f %7.3f %7.1f  %s\n", pattern.id,
              pattern.name.c_str(), pattern.entry_class.c_str(), pattern.exit_class.c_str(),
              static_cast<double>(pattern.commands.size()) * period, pattern.pathLength(), end.x,
              end.y, end.yaw * kDegrees, spread(pattern.end_covariance).c_str());
}

}  // namespace

std::string table(const PatternSet& set) {
  const PatternSetContent& content = set.content();
  const bool power = content.kind == CommandKind::kPower;
  std::string text =
      line("%s: version %lld, %zu patterns, %s, %g ms a sample\n", content.name.c_str(),
           static_cast<long long>(content.version), content.patterns.size(),
           power ? "power" : "track speed", set.periodSeconds() * 1e3);
  for (const MotionClass& motion : content.classes)
    text += line("  %-8s %.3f m/s, %.3f m/s to the left, %.3f rad/s at command %g, %g\n",
                 motion.name.c_str(), motion.twist.v_x, motion.twist.v_y, motion.twist.omega,
                 motion.steady.left, motion.steady.right);
  text += line("%4s  %-16s %-8s %-8s %5s %7s  %7s %7s %7s  %s\n", "id", "name", "entry", "exit",
               "s", "m", "end x", "end y", "deg", "spread x y m, deg");
  for (const MotionPattern& pattern : content.patterns) text += row(pattern, set.periodSeconds());
  return text;
}

}  // namespace tread::patterns
