// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/pattern/pattern_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>

namespace tread {
namespace {

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

// Names travel through YAML, messages and tables, so they stay printable ASCII without quotes.
bool isName(const std::string& name) {
  const auto fits = [](char c) {
    return c >= ' ' && c <= '~' && c != '"' && c != '\'' && c != '\\';
  };
  return !name.empty() && name.size() <= PatternLimits::kMaxNameLength && name.front() != ' ' &&
         name.back() != ' ' && std::all_of(name.begin(), name.end(), fits);
}

std::string nameProblem(const std::string& what) {
  return what + ": bad name; 1 to " + std::to_string(PatternLimits::kMaxNameLength) +
         " printable ASCII characters without quotes, backslash or blanks at the ends";
}

std::string commandProblem(const TrackCommand& command, CommandKind kind) {
  const double limit = commandLimit(kind);
  const char* unit = kind == CommandKind::kPower ? "" : " m/s";
  for (const double value : {command.left, command.right}) {
    if (!(std::abs(value) <= limit))  // also catches NaN
      return "command " + number(value) + unit + "; allowed is -" + number(limit) + " to " +
             number(limit) + unit;
  }
  return {};
}

std::string twistProblem(const Twist2& twist) {
  if (!(std::hypot(twist.v_x, twist.v_y) <= PatternLimits::kMaxSpeed))
    return "speed " + number(std::hypot(twist.v_x, twist.v_y)) + " m/s; allowed is up to " +
           number(PatternLimits::kMaxSpeed) + " m/s";
  if (!(std::abs(twist.omega) <= PatternLimits::kMaxYawRate))
    return "yaw rate " + number(twist.omega) + " rad/s; allowed is up to +-" +
           number(PatternLimits::kMaxYawRate) + " rad/s";
  return {};
}

std::string headProblem(const PatternSetContent& content) {
  if (!isName(content.name)) return nameProblem("set");
  if (content.version < 1)
    return "set: version " + std::to_string(content.version) + "; versions count up from 1";
  if (content.parent_version < 0 || content.parent_version >= content.version)
    return "set: parent version " + std::to_string(content.parent_version) +
           "; allowed is 0 (none) or a version before " + std::to_string(content.version);
  if (content.utime < 0)
    return "set: utime " + std::to_string(content.utime) + "; allowed is 0 or later";
  if (content.kind != CommandKind::kPower && content.kind != CommandKind::kTrackSpeed)
    return "set: unknown command kind; allowed are power and track speed";
  if (content.period_us < PatternLimits::kMinPeriodUs ||
      content.period_us > PatternLimits::kMaxPeriodUs)
    return "set: period " + std::to_string(content.period_us) + " us; allowed is " +
           std::to_string(PatternLimits::kMinPeriodUs) + " to " +
           std::to_string(PatternLimits::kMaxPeriodUs) + " us";
  if (content.patterns.empty() || content.patterns.size() > PatternLimits::kMaxPatterns)
    return "set: " + std::to_string(content.patterns.size()) + " patterns; allowed is 1 to " +
           std::to_string(PatternLimits::kMaxPatterns);
  return {};
}

std::string classProblem(const MotionClass& motion, const PatternSetContent& content) {
  if (!isName(motion.name)) return nameProblem("class '" + motion.name + "'");
  const std::string where = "class '" + motion.name + "': ";
  if (const std::string problem = twistProblem(motion.twist); !problem.empty())
    return where + problem;
  if (const std::string problem = commandProblem(motion.steady, content.kind); !problem.empty())
    return where + "steady " + problem;
  const auto uses = [&](const MotionPattern& pattern) {
    return pattern.entry_class == motion.name || pattern.exit_class == motion.name;
  };
  // The bus transports classes only with patterns: an unused one would be lost on the way.
  if (std::none_of(content.patterns.begin(), content.patterns.end(), uses))
    return where + "no pattern begins or ends in it; remove it or use it";
  return {};
}

std::string classesProblem(const PatternSetContent& content) {
  std::set<std::string> names;
  for (const MotionClass& motion : content.classes) {
    if (!names.insert(motion.name).second)
      return "class '" + motion.name + "': name used twice; class names are unique";
    if (const std::string problem = classProblem(motion, content); !problem.empty()) return problem;
  }
  return {};
}

std::string stepProblem(const Pose2& from, const Pose2& to, double period) {
  if (!std::isfinite(to.x) || !std::isfinite(to.y) || !std::isfinite(to.yaw))
    return "pose that is not finite; give x, y [m] and yaw [rad]";
  const double speed = std::hypot(to.x - from.x, to.y - from.y) / period;
  if (std::string problem = twistProblem({speed, 0.0, (to.yaw - from.yaw) / period});
      !problem.empty())
    return "jump of the trajectory: " + problem;
  return {};
}

std::string covarianceProblem(const PoseCovariance& covariance) {
  const auto unknown = std::count_if(covariance.begin(), covariance.end(),
                                     [](double value) { return std::isnan(value); });
  if (unknown == static_cast<std::ptrdiff_t>(covariance.size())) return {};
  const auto finite = [](double value) { return std::isfinite(value); };
  if (!std::all_of(covariance.begin(), covariance.end(), finite))
    return "end covariance is not finite; give six finite numbers, or all six NaN for unknown";
  if (covariance[0] < 0.0 || covariance[3] < 0.0 || covariance[5] < 0.0)
    return "end covariance has a negative variance; variances are 0 or more";
  return {};
}

std::string seriesProblem(const MotionPattern& pattern, CommandKind kind, double period) {
  const size_t count = pattern.commands.size();
  if (count == 0 || count > PatternLimits::kMaxSamples)
    return std::to_string(count) + " commands; allowed is 1 to " +
           std::to_string(PatternLimits::kMaxSamples);
  if (pattern.trajectory.size() != count)
    return std::to_string(count) + " commands but " + std::to_string(pattern.trajectory.size()) +
           " poses; each command has one pose";
  Pose2 last;
  for (size_t i = 0; i < count; ++i) {
    const std::string at = "sample " + std::to_string(i + 1) + ": ";
    if (const std::string problem = commandProblem(pattern.commands[i], kind); !problem.empty())
      return at + problem;
    if (const std::string problem = stepProblem(last, pattern.trajectory[i], period);
        !problem.empty())
      return at + problem;
    last = pattern.trajectory[i];
  }
  return {};
}

std::string patternProblem(const MotionPattern& pattern, const PatternSetContent& content) {
  if (pattern.id < 0) return "id " + std::to_string(pattern.id) + "; ids are 0 or more";
  if (pattern.times_learned < 0)
    return "times learned " + std::to_string(pattern.times_learned) + "; allowed is 0 or more";
  for (const std::string& name : {pattern.entry_class, pattern.exit_class}) {
    const auto named = [&](const MotionClass& motion) { return motion.name == name; };
    if (std::none_of(content.classes.begin(), content.classes.end(), named))
      return "class '" + name + "' is not in the set; entry and exit name one of its classes";
  }
  const double period = static_cast<double>(content.period_us) * 1e-6;
  if (std::string problem = seriesProblem(pattern, content.kind, period); !problem.empty())
    return problem;
  return covarianceProblem(pattern.end_covariance);
}

}  // namespace

double commandLimit(CommandKind kind) {
  return kind == CommandKind::kPower ? 1.0 : PatternLimits::kMaxSpeed;
}

std::string firstProblem(const PatternSetContent& content) {
  if (std::string problem = headProblem(content); !problem.empty()) return problem;
  if (std::string problem = classesProblem(content); !problem.empty()) return problem;
  std::set<int> ids;
  std::set<std::string> names;
  for (const MotionPattern& pattern : content.patterns) {
    const std::string where = "pattern '" + pattern.name + "'";
    if (!isName(pattern.name)) return nameProblem(where);
    if (!names.insert(pattern.name).second)
      return where + ": name used twice; pattern names are unique";
    if (!ids.insert(pattern.id).second)
      return where + ": id " + std::to_string(pattern.id) + " used twice; ids are unique";
    if (const std::string problem = patternProblem(pattern, content); !problem.empty())
      return where + ": " + problem;
  }
  return {};
}

}  // namespace tread
