// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/robot/patterns/recipe.hpp"

#include <algorithm>
#include <cmath>
#include <iostream>
#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

#include "common/report/text.hpp"
#include "common/vehicle/kernel.hpp"
#include "common/vehicle/omni_kernel.hpp"
#include "tools/robot/patterns/set_text.hpp"

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

/// People describe the motion of a holonomic base as a twist: converts forward and sideways speed
/// [m/s] and yaw rate [rad/s] to wheel commands.
Command wheelCommand(const VehicleModel& model, const Twist2& v_body) {
  Command command = model.wheels.speeds(v_body);
  const double unit = model.kind == CommandKind::kTrackSpeed ? 1.0 : model.full_speed;
  for (size_t i = 0; i < model.wheels.size(); ++i) command[i] = roundedTo(command[i] / unit, 1e-6);
  return command;
}

/// Number of command columns in a recipe.
size_t columnsOf(const VehicleModel& model) {
  return model.isOmni() ? 3 : 2;
}

/// The command with left and right exchanged.
Command mirroredBy(const VehicleModel& model, const Command& command) {
  if (!model.isOmni()) return mirroredCommand(command, model.channels());
  const double unit = model.kind == CommandKind::kTrackSpeed ? 1.0 : model.full_speed;
  const Twist2 twist = model.wheels.twist(command);
  return wheelCommand(model, {unit * twist.v_x, -unit * twist.v_y, -unit * twist.omega});
}

MotionClass readClass(ConfigReader& reader, const VehicleModel& model) {
  std::string name;
  reader.text("name", name, true);
  std::vector<double> steady;
  const CommandChannels channels = model.channels();
  const double limit = model.isOmni() ? PatternLimits::kMaxSpeed
                                      : std::max(channels[0].highest, channels[1].highest);
  reader.numbers("steady", steady, columnsOf(model), {-limit, limit}, "", true);
  MotionClass motion = classOf(model, name, commandOf(model, steady));
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

std::vector<Command> readCommands(ConfigReader& reader, const VehicleModel& model, double period) {
  std::vector<std::vector<double>> rows;
  reader.table("commands", rows, columnsOf(model) + 1,
               {-PatternLimits::kMaxSpeed, PatternLimits::kMaxSpeed}, "", true);
  std::vector<Command> commands;
  for (const std::vector<double>& row : rows) {
    const double samples = std::round(row.back() / period);
    if (samples < 1.0 || std::abs(samples * period - row.back()) > 1e-9)
      throw reader.error("commands", "held for " + number(row.back()) +
                                         " s; allowed are multiples of " + "the period, " +
                                         number(period) + " s");
    commands.insert(commands.end(), static_cast<size_t>(samples), commandOf(model, row));
  }
  return commands;
}

double heldAtEnd(const std::vector<Command>& commands, const Command& steady, double period) {
  size_t held = 0;
  for (size_t i = commands.size(); i > 0; --i, ++held)
    if (commands[i - 1] != steady) break;
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
  pattern.commands = readCommands(reader, model, period);
  requireHold(reader, pattern, exit, model, period);
  addPattern(content, pattern, entry, model);
  if (!reader.has("mirror")) return;
  for (const MotionClass* motion : {&entry, &exit})
    if (mirroredBy(model, motion->steady) != motion->steady)
      throw reader.error("mirror", "class '" + motion->name + "' turns; only patterns between " +
                                       "classes that go straight can be mirrored");
  reader.text("mirror", pattern.name);
  for (Command& command : pattern.commands) command = mirroredBy(model, command);
  addPattern(content, pattern, entry, model);
}

constexpr double kLeadIn = 3.0;  // [s], longer than the latency of any INS

void hold(VehicleKernel& kernel, const Command& command, double period) {
  kernel.step(command.tracks(), period);
}
void hold(OmniKernel& kernel, const Command& command, double period) {
  kernel.step(command, period);
}

/// [periods] of the lead-in.
size_t leadIn(double period) {
  return static_cast<size_t>(kLeadIn / period) + 1;
}

/// An execution as measured by a late, misaligned or biased INS, relative to its measured start.
template <class Kernel>
recordings::Execution seenByIns(const ModelDocument& model, const MotionPattern& pattern,
                                double period, const Command& entry, Kernel kernel) {
  const size_t before = leadIn(period);
  const double begin = -period * static_cast<double>(before);
  std::vector<MotionSample> motion{{begin, kernel.pose(), kernel.twist().omega}};
  for (size_t i = 0; i < before + pattern.commands.size(); ++i) {
    hold(kernel, i < before ? entry : pattern.commands[i - before], period);
    const double time = begin + period * static_cast<double>(motion.size());
    motion.push_back({time, kernel.pose(), kernel.twist().omega});
  }
  const std::vector<MotionSample> said = measure(motion, model.measurement);
  recordings::Execution seen;
  for (size_t i = before + 1; i < said.size(); ++i)
    seen.push_back(between(said[before].T_map_body, said[i].T_map_body));
  return seen;
}

recordings::Execution seenByIns(const ModelDocument& model, const MotionPattern& pattern,
                                double period, const Command& steady, const ExecutionNoise& noise) {
  if (model.vehicle.isOmni())
    return seenByIns(model, pattern, period, steady, OmniKernel(model.vehicle, steady, noise));
  EntryState entry = steadyEntry(model.vehicle, steady.tracks());
  entry.context.session_time = -period * static_cast<double>(leadIn(period));
  return seenByIns(model, pattern, period, steady, VehicleKernel(model.vehicle, entry, noise));
}

recordings::Execution execute(const ModelDocument& model, const MotionPattern& pattern,
                              double period, const Command& entry, const ModelRecording& how,
                              std::mt19937_64& random) {
  const ExecutionNoise noise = drawNoise(model.vehicle.spread, random);
  recordings::Execution measured =
      isPerfect(model.measurement)
          ? simulateFrom(model.vehicle, entry, pattern.commands, period, noise)
          : seenByIns(model, pattern, period, entry, noise);
  std::normal_distribution<double> standard;
  for (Pose2& pose : measured) {
    pose.x += how.position * standard(random);
    pose.y += how.position * standard(random);
    pose.yaw += how.yaw * standard(random);
  }
  return measured;
}

Envelope envelopeOf(const VehicleModel& model, const MotionPattern& pattern, const Command& steady,
                    double period) {
  if (!model.isOmni())
    return tread::envelopeOf(model, tracksOf(pattern.commands), period,
                             steadyEntry(model, steady.tracks()));
  OmniKernel kernel(model, steady);
  Envelope envelope;
  const auto include = [&](const Twist2& v_body) {
    envelope.include({std::hypot(v_body.v_x, v_body.v_y), 0.0, v_body.omega});
  };
  include(kernel.twist());
  for (const Command& command : pattern.commands) {
    kernel.step(command, period);
    include(kernel.twist());
  }
  return envelope;
}

/// An independent random series for each surface and pattern.
std::mt19937_64 randomFor(uint64_t seed, const std::string& surface, int pattern_id) {
  std::vector<uint32_t> words{static_cast<uint32_t>(seed), static_cast<uint32_t>(seed >> 32U),
                              static_cast<uint32_t>(pattern_id)};
  for (const char letter : surface) words.push_back(static_cast<unsigned char>(letter));
  std::seed_seq seeds(words.begin(), words.end());
  return std::mt19937_64(seeds);
}

}  // namespace

Command commandOf(const VehicleModel& model, const std::vector<double>& row) {
  if (model.isOmni()) return wheelCommand(model, {row[0], row[1], row[2]});
  return {row[0], row[1]};
}

PatternSet makeSet(ConfigReader recipe, const VehicleModel& model) {
  PatternSetContent content;
  content.channels = model.channels();
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

void requireSameKind(const PatternSet& set, const VehicleModel& model) {
  const CommandChannels taken = model.channels();
  if (set.content().channels != taken)
    throw std::runtime_error("the patterns command " + describe(set.content().channels) +
                             ", the model takes " + describe(taken) +
                             "; give a model of the same vehicle");
}

recordings::SurfaceRecordings recordModel(const PatternSet& set, const ModelDocument& model,
                                          const std::string& surface, const ModelRecording& how) {
  requireSameKind(set, model.vehicle);
  recordings::SurfaceRecordings recorded{surface, {}};
  for (const MotionPattern& pattern : set.patterns()) {
    std::mt19937_64 random = randomFor(how.seed, surface, pattern.id);
    const Command& entry = set.classNamed(pattern.entry_class).steady;
    std::vector<recordings::Execution> executions;
    for (int e = 0; e < how.executions; ++e)
      executions.push_back(execute(model, pattern, set.periodSeconds(), entry, how, random));
    recorded.executions.push_back(std::move(executions));
  }
  return recorded;
}

Envelope envelopeOf(const VehicleModel& model, const PatternSet& set) {
  Envelope all;
  for (const MotionPattern& pattern : set.patterns()) {
    const Envelope one =
        envelopeOf(model, pattern, set.classNamed(pattern.entry_class).steady, set.periodSeconds());
    all.v = std::max(all.v, one.v);
    all.omega = std::max(all.omega, one.omega);
    all.v_omega = std::max(all.v_omega, one.v_omega);
  }
  return all;
}

void warnOutside(const ModelDocument& document, const std::string& model_file,
                 const PatternSet& set) {
  requireSameKind(set, document.vehicle);
  if (!document.envelope) return;
  for (const std::string& line :
       warningsOutside(*document.envelope, envelopeOf(document.vehicle, set)))
    std::cerr << model_file << ": warning: " << line << '\n';
}

}  // namespace tread::patterns
