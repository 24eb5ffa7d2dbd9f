// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors

#include "common/pattern/pattern_check.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <set>
#include <utility>

namespace tread {
namespace {

/// Key of the file and "what is wrong; what is allowed".
using Finding = std::optional<std::pair<std::string, std::string>>;

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.6g", value);
  return text;
}

std::string upTo(double limit, const char* unit) {
  return "; allowed is up to " + number(limit) + unit;
}

// A refused name may contain anything; the message stays one line.
std::string quoted(std::string name) {
  for (char& c : name) {
    if (c < ' ' || c > '~') c = '?';
  }
  return "'" + name.substr(0, PatternLimits::kMaxNameLength) + "'";
}

// Names travel through YAML, messages and tables, so they stay printable ASCII without quotes.
bool isName(const std::string& name) {
  const auto fits = [](char c) {
    return c >= ' ' && c <= '~' && c != '"' && c != '\'' && c != '\\';
  };
  return !name.empty() && name.size() <= PatternLimits::kMaxNameLength && name.front() != ' ' &&
         name.back() != ' ' && std::all_of(name.begin(), name.end(), fits);
}

Finding nameProblem(const std::string& name) {
  if (isName(name)) return {};
  return {{"name", "bad name; allowed are 1 to " + std::to_string(PatternLimits::kMaxNameLength) +
                       " printable ASCII characters without quotes and backslash, no blank at "
                       "either end"}};
}

std::string commandProblem(const Command& command, const CommandChannels& channels) {
  for (size_t i = 0; i < Command::kMaxChannels; ++i) {
    const double value = command[i];
    if (i >= channels.size()) {
      if (value != 0.0) return "command beyond the last channel; leave it 0";
      continue;
    }
    const CommandChannel& channel = channels[i];
    if (value >= channel.lowest && value <= channel.highest) continue;  // not for NaN
    const std::string unit = unitOf(channel.kind);
    const std::string what = kindOfTracks(channels) ? "command " : channel.name + " command ";
    return what + number(value) + unit + "; allowed is " + number(channel.lowest) + " to " +
           number(channel.highest) + unit;
  }
  return {};
}

Finding channelProblem(const CommandChannels& channels) {
  if (channels.empty() || channels.size() > Command::kMaxChannels)
    return {{"channels", std::to_string(channels.size()) + " command channels; allowed are 1 to " +
                             std::to_string(Command::kMaxChannels)}};
  std::set<std::string> names;
  for (const CommandChannel& channel : channels) {
    if (nameOf(channel.kind)[0] == '\0')
      return {{"kind", "unknown command kind; allowed are power, track speed and steering angle"}};
    if (!isName(channel.name) || !names.insert(channel.name).second)
      return {{"channels", "channel " + quoted(channel.name) +
                               "; each channel has a name of its own in printable ASCII"}};
    const double limit = commandLimit(channel.kind);
    if (!(channel.lowest >= -limit && channel.lowest <= 0.0 && channel.highest >= 0.0 &&
          channel.highest <= limit && channel.lowest < channel.highest))
      return {{"channels", "channel " + quoted(channel.name) + " from " + number(channel.lowest) +
                               " to " + number(channel.highest) +
                               "; a range holds 0 and lies within +-" + number(limit) +
                               unitOf(channel.kind)}};
  }
  return {};
}

std::string twistProblem(const Twist2& twist) {
  const double speed = std::hypot(twist.v_x, twist.v_y);
  if (!(speed <= PatternLimits::kMaxSpeed))
    return "speed " + number(speed) + " m/s" + upTo(PatternLimits::kMaxSpeed, " m/s");
  if (!(std::abs(twist.omega) <= PatternLimits::kMaxYawRate))
    return "yaw rate " + number(twist.omega) + " rad/s" +
           upTo(PatternLimits::kMaxYawRate, " rad/s");
  return {};
}

Finding setProblem(const PatternSetContent& content) {
  if (Finding finding = nameProblem(content.name)) return finding;
  if (content.version < 1)
    return {
        {"version", "version " + std::to_string(content.version) + "; versions count up from 1"}};
  if (content.parent_version < 0 || content.parent_version >= content.version)
    return {{"parent_version", "parent version " + std::to_string(content.parent_version) +
                                   "; allowed is 0 (none) or a version before " +
                                   std::to_string(content.version)}};
  if (content.utime < 0)
    return {{"utime", "utime " + std::to_string(content.utime) + " us; allowed is 0 or later"}};
  if (Finding finding = channelProblem(content.channels)) return finding;
  if (content.period_us < PatternLimits::kMinPeriodUs ||
      content.period_us > PatternLimits::kMaxPeriodUs)
    return {{"period_us", "period " + std::to_string(content.period_us) + " us; allowed is " +
                              std::to_string(PatternLimits::kMinPeriodUs) + " to " +
                              std::to_string(PatternLimits::kMaxPeriodUs) + " us"}};
  if (content.patterns.empty() || content.patterns.size() > PatternLimits::kMaxPatterns)
    return {{"patterns", std::to_string(content.patterns.size()) + " patterns; allowed are 1 to " +
                             std::to_string(PatternLimits::kMaxPatterns)}};
  return {};
}

Finding classProblem(const MotionClass& motion, const PatternSetContent& content) {
  if (Finding finding = nameProblem(motion.name)) return finding;
  if (const std::string problem = twistProblem(motion.twist); !problem.empty())
    return {{"twist", problem}};
  if (const std::string problem = commandProblem(motion.steady, content.channels); !problem.empty())
    return {{"steady", "steady " + problem}};
  const auto uses = [&](const MotionPattern& pattern) {
    return pattern.entry_class == motion.name || pattern.exit_class == motion.name;
  };
  // The bus transports classes only with patterns: an unused one would be lost.
  if (std::none_of(content.patterns.begin(), content.patterns.end(), uses))
    return {{"name", "no pattern begins or ends in this class; remove it or use it"}};
  return {};
}

std::string stepProblem(const Pose2& from, const Pose2& to, double period) {
  if (!std::isfinite(to.x) || !std::isfinite(to.y) || !std::isfinite(to.yaw))
    return "pose is not finite; give x, y [m] and yaw [rad]";
  const double speed = std::hypot(to.x - from.x, to.y - from.y) / period;
  const std::string problem = twistProblem({speed, 0.0, (to.yaw - from.yaw) / period});
  return problem.empty() ? problem : "the trajectory jumps: " + problem;
}

Finding lengthProblem(const MotionPattern& pattern, size_t channels) {
  const size_t count = pattern.commands.size();
  if (count == 0 || count > PatternLimits::kMaxSamples)
    return {{"commands", std::to_string(count) + " commands; allowed are 1 to " +
                             std::to_string(PatternLimits::kMaxSamples)}};
  if (count * channels > PatternLimits::kMaxNumbers)
    return {{"commands", std::to_string(count) + " commands of " + std::to_string(channels) +
                             " channels; allowed are " +
                             std::to_string(PatternLimits::kMaxNumbers) + " numbers"}};
  if (pattern.trajectory.size() != count)
    return {{"trajectory", std::to_string(count) + " commands but " +
                               std::to_string(pattern.trajectory.size()) +
                               " poses; each command has one pose"}};
  return {};
}

/// Quick check whether a sample is certainly valid, as most are; false for NaN.
bool surelyRight(const Command& command, const CommandChannels& channels, const Pose2& from,
                 const Pose2& to, double period) {
  for (size_t i = 0; i < channels.size(); ++i)
    if (!(command[i] >= channels[i].lowest && command[i] <= channels[i].highest)) return false;
  for (size_t i = channels.size(); i < Command::kMaxChannels; ++i)
    if (command[i] != 0.0) return false;
  const double longest = 0.999 * PatternLimits::kMaxSpeed * period;
  const double dx = to.x - from.x, dy = to.y - from.y;
  return dx * dx + dy * dy <= longest * longest &&
         std::abs(to.yaw - from.yaw) <= 0.999 * PatternLimits::kMaxYawRate * period;
}

Finding seriesProblem(const MotionPattern& pattern, const CommandChannels& channels,
                      double period) {
  if (Finding finding = lengthProblem(pattern, channels.size())) return finding;
  Pose2 last;
  for (size_t i = 0; i < pattern.commands.size(); ++i) {
    if (surelyRight(pattern.commands[i], channels, last, pattern.trajectory[i], period)) {
      last = pattern.trajectory[i];
      continue;
    }
    const std::string sample = "sample " + std::to_string(i + 1) + ": ";
    if (const std::string problem = commandProblem(pattern.commands[i], channels); !problem.empty())
      return {{"commands", sample + problem}};
    const Pose2& pose = pattern.trajectory[i];
    if (const std::string problem = stepProblem(last, pose, period); !problem.empty())
      return {{"trajectory", sample + problem}};
    last = pose;
  }
  return {};
}

Finding covarianceProblem(const PoseCovariance& covariance) {
  const auto unknown = std::count_if(covariance.begin(), covariance.end(),
                                     [](double value) { return std::isnan(value); });
  if (unknown == static_cast<std::ptrdiff_t>(covariance.size())) return {};
  const auto finite = [](double value) { return std::isfinite(value); };
  if (!std::all_of(covariance.begin(), covariance.end(), finite))
    return {{"end_covariance",
             "end covariance is not finite; give six numbers, or none (all six NaN) for unknown"}};
  if (covariance[0] < 0.0 || covariance[3] < 0.0 || covariance[5] < 0.0)
    return {{"end_covariance", "negative variance; variances are 0 or more"}};
  return {};
}

Finding joinProblem(const MotionPattern& pattern, const PatternSetContent& content) {
  for (const auto& [key, name] :
       {std::pair<const char*, const std::string&>{"entry", pattern.entry_class},
        std::pair<const char*, const std::string&>{"exit", pattern.exit_class}}) {
    const auto named = [&wanted = name](const MotionClass& motion) {
      return motion.name == wanted;
    };
    if (std::none_of(content.classes.begin(), content.classes.end(), named))
      return {{key, "class " + quoted(name) +
                        " is not in the set; entry and exit name one of its classes"}};
  }
  return {};
}

Finding patternProblem(const MotionPattern& pattern, const PatternSetContent& content) {
  if (Finding finding = nameProblem(pattern.name)) return finding;
  if (pattern.id < 0)
    return {{"id", "id " + std::to_string(pattern.id) + "; allowed is 0 or more"}};
  if (pattern.times_learned < 0)
    return {{"times_learned",
             "times learned " + std::to_string(pattern.times_learned) + "; allowed is 0 or more"}};
  if (Finding finding = joinProblem(pattern, content)) return finding;
  const double period = static_cast<double>(content.period_us) * 1e-6;
  if (Finding finding = seriesProblem(pattern, content.channels, period)) return finding;
  return covarianceProblem(pattern.end_covariance);
}

PatternProblem at(PatternProblem::Place place, size_t index, const Finding& finding) {
  return {place, index, finding->first, finding->second};
}

std::optional<PatternProblem> firstClassProblem(const PatternSetContent& content) {
  constexpr auto kPlace = PatternProblem::Place::kClass;
  std::set<std::string> names;
  for (size_t i = 0; i < content.classes.size(); ++i) {
    const MotionClass& motion = content.classes[i];
    if (const Finding finding = classProblem(motion, content)) return at(kPlace, i, finding);
    if (!names.insert(motion.name).second)
      return PatternProblem{kPlace, i, "name", "name used twice; class names are unique"};
  }
  return {};
}

std::optional<PatternProblem> firstPatternProblem(const PatternSetContent& content) {
  constexpr auto kPlace = PatternProblem::Place::kPattern;
  std::set<int> ids;
  std::set<std::string> names;
  for (size_t i = 0; i < content.patterns.size(); ++i) {
    const MotionPattern& pattern = content.patterns[i];
    if (const Finding finding = patternProblem(pattern, content)) return at(kPlace, i, finding);
    if (!names.insert(pattern.name).second)
      return PatternProblem{kPlace, i, "name", "name used twice; pattern names are unique"};
    if (!ids.insert(pattern.id).second)
      return PatternProblem{kPlace, i, "id",
                            "id " + std::to_string(pattern.id) + " used twice; ids are unique"};
  }
  return {};
}

}  // namespace

std::string PatternProblem::line(const PatternSetContent& content) const {
  switch (place) {
    case Place::kClass:
      return "class " + quoted(content.classes[index].name) + ": " + problem;
    case Place::kPattern:
      return "pattern " + quoted(content.patterns[index].name) + ": " + problem;
    default:
      return "pattern set " + quoted(content.name) + ": " + problem;
  }
}

std::optional<PatternProblem> firstProblem(const PatternSetContent& content) {
  if (const Finding finding = setProblem(content))
    return at(PatternProblem::Place::kSet, 0, finding);
  if (auto problem = firstPatternProblem(content)) return problem;
  return firstClassProblem(content);
}

}  // namespace tread
