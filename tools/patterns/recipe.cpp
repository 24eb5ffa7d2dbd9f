// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/patterns/recipe.hpp"

#include <cmath>
#include <utility>
#include <vector>

#include "common/pattern/pattern_check.hpp"
#include "common/report/text.hpp"
#include "common/vehicle/kernel.hpp"

namespace tread::patterns {
namespace {

constexpr double kLagsToHold = 3.0;  // 95 % of a change of speed is over by then

std::string number(double value) {
  return formatted("%.4g", value);
}

double roundedTo(double value, double unit) {
  const double rounded = std::round(value / unit);
  return rounded == 0.0 ? 0.0 : rounded / std::round(1.0 / unit);
}

double sixDigits(double value) {
  return std::stod(formatted("%.5e", value)) + 0.0;  // -0 becomes 0
}

MotionClass readClass(ConfigReader& reader, const VehicleModel& model) {
  std::string name;
  reader.text("name", name, true);
  std::vector<double> steady;
  const double limit = commandLimit(model.kind);
  reader.numbers("steady", steady, 2, {-limit, limit}, "", true);
  MotionClass motion = classOf(model, name, {steady[0], steady[1]});
  motion.twist = {roundedTo(motion.twist.v_x, 1e-6), roundedTo(motion.twist.v_y, 1e-6),
                  roundedTo(motion.twist.omega, 1e-6)};
  return motion;
}

const MotionClass& classNamed(ConfigReader& reader, const std::string& key,
                              const std::vector<MotionClass>& classes) {
  std::vector<std::string> names;
  names.reserve(classes.size());
  for (const MotionClass& motion : classes) names.push_back(motion.name);
  std::string name;
  reader.choice(key, name, names, true);
  for (const MotionClass& motion : classes)
    if (motion.name == name) return motion;
  throw reader.error(key, "unknown class '" + name + "'; allowed are the classes of the recipe");
}

std::vector<TrackCommand> readCommands(ConfigReader& reader, double period) {
  std::vector<std::vector<double>> rows;
  reader.table("commands", rows, 3, {-PatternLimits::kMaxSpeed, PatternLimits::kMaxSpeed}, "",
               true);
  std::vector<TrackCommand> commands;
  for (const std::vector<double>& row : rows) {
    const double samples = std::round(row[2] / period);
    if (samples < 1.0 || std::abs(samples * period - row[2]) > 1e-9)
      throw reader.error("commands", "held for " + number(row[2]) +
                                         " s; allowed are multiples of " + "the period, " +
                                         number(period) + " s");
    commands.insert(commands.end(), static_cast<size_t>(samples), {row[0], row[1]});
  }
  return commands;
}

double heldAtEnd(const std::vector<TrackCommand>& commands, const TrackCommand& steady,
                 double period) {
  size_t held = 0;
  for (size_t i = commands.size(); i > 0; --i, ++held)
    if (commands[i - 1].left != steady.left || commands[i - 1].right != steady.right) break;
  return static_cast<double>(held) * period;
}

void requireHold(const ConfigReader& reader, const MotionPattern& pattern, const MotionClass& exit,
                 const VehicleModel& model, double period) {
  const double needed = kLagsToHold * model.settlingLag() + model.commandDelay();
  const double held = heldAtEnd(pattern.commands, exit.steady, period);
  if (held < needed - 1e-9)
    throw reader.error("commands", "the steady command of exit class '" + exit.name +
                                       "' is held for " + number(held) + " s; at least " +
                                       number(needed) + " s needed, three lags and the delay");
}

void addPattern(PatternSetContent& content, MotionPattern pattern, const MotionClass& entry,
                const VehicleModel& model) {
  pattern.id = static_cast<int>(content.patterns.size()) + 1;
  predict(model, static_cast<double>(content.period_us) * 1e-6, entry, pattern);
  for (Pose2& pose : pattern.trajectory)
    pose = {roundedTo(pose.x, 1e-6), roundedTo(pose.y, 1e-6), roundedTo(pose.yaw, 1e-6)};
  for (double& value : pattern.end_covariance) value = sixDigits(value);
  content.patterns.push_back(std::move(pattern));
}

void readPattern(ConfigReader& reader, const VehicleModel& model, PatternSetContent& content) {
  const double period = static_cast<double>(content.period_us) * 1e-6;
  MotionPattern pattern;
  reader.text("name", pattern.name, true);
  const MotionClass& entry = classNamed(reader, "entry", content.classes);
  const MotionClass& exit = classNamed(reader, "exit", content.classes);
  pattern.entry_class = entry.name;
  pattern.exit_class = exit.name;
  pattern.commands = readCommands(reader, period);
  requireHold(reader, pattern, exit, model, period);
  addPattern(content, pattern, entry, model);
  if (!reader.has("mirror")) return;
  for (const MotionClass* motion : {&entry, &exit})
    if (motion->steady.left != motion->steady.right)
      throw reader.error("mirror", "class '" + motion->name + "' turns; only patterns between " +
                                       "classes that go straight can be mirrored");
  reader.text("mirror", pattern.name);
  for (TrackCommand& command : pattern.commands) std::swap(command.left, command.right);
  addPattern(content, pattern, entry, model);
}

}  // namespace

PatternSet makeSet(ConfigReader recipe, const VehicleModel& model) {
  PatternSetContent content;
  content.kind = model.kind;
  recipe.text("name", content.name, true);
  double period = 0.05;
  recipe.number("period", period, {0.005, 1.0}, "s", true);
  content.period_us = std::llround(period * 1e6);
  for (ConfigReader& motion : recipe.sections("classes", true))
    content.classes.push_back(readClass(motion, model));
  for (ConfigReader& pattern : recipe.sections("patterns", true))
    readPattern(pattern, model, content);
  recipe.finish();
  std::string why;
  std::optional<PatternSet> set = PatternSet::make(std::move(content), why);
  if (!set) throw recipe.error("patterns", why);
  return *set;
}

}  // namespace tread::patterns
