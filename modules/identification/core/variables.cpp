// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Quantities on which residuals may depend.
#include "modules/identification/core/variables.hpp"

#include <algorithm>
#include <cmath>

#include "modules/identification/core/search.hpp"

namespace tread::gap {
namespace {

constexpr double kBack = 0.5;        // [s] before an observation, for the preceding motion
constexpr double kRemembered = 0.8;  // [rad] of turning after which earlier turns are forgotten
constexpr double kSlipped = 0.3;     // [m] after which a reversal is forgotten
constexpr double kArm = 0.4;         // [m] path of a track in a turn on the spot, over its angle
constexpr double kSettles = 0.5;     // [s] of standing
constexpr double kStill = 0.02;      // [m/s] below it the direction does not change
constexpr double kBefore = 1.2;      // [s] over which commands count as preceding
constexpr double kLongSince = 3.0;   // [s] after which a command counts as old

/// A vehicle's recent past before a sample of its motion.
struct Past {
  double turned = 0.0;    ///< direction of the recent turns, -1..1, forgotten by turning
  double reversed = 0.0;  ///< 1 just after a change of direction, forgotten by distance
  double rested = 0.0;    ///< 1 after a standstill, forgotten in the same way
};

std::vector<Past> pastOf(const std::vector<MotionSample>& motion) {
  std::vector<Past> past(motion.size());
  double direction = 0.0;
  for (size_t i = 1; i < motion.size(); ++i) {
    const double dt = motion[i].time - motion[i - 1].time;
    const Pose2 moved = between(motion[i - 1].T_map_body, motion[i].T_map_body);
    past[i] = past[i - 1];
    past[i].turned += (moved.yaw - past[i].turned * std::abs(moved.yaw)) / kRemembered;
    past[i].turned = std::clamp(past[i].turned, -1.0, 1.0);
    const double way = std::abs(moved.x) + kArm * std::abs(moved.yaw);
    past[i].reversed *= std::exp(-way / kSlipped);
    past[i].rested *= std::exp(-way / kSlipped);
    if (way < kStill * dt) past[i].rested += (1.0 - past[i].rested) * dt / kSettles;
    if (!(dt > 0.0) || std::abs(moved.x) < kStill * dt) continue;
    const double now = moved.x > 0.0 ? 1.0 : -1.0;
    if (direction * now < 0.0) past[i].reversed = 1.0;
    direction = now;
  }
  return past;
}

/// The vehicle's motion during one observation.
struct Conditions {
  double v = 0.0;             // [m/s]
  double omega = 0.0;         // [rad/s]
  double v_change = 0.0;      // [m/s2] against just before
  double speed_change = 0.0;  // [m/s2] of |v|
  double omega_change = 0.0;
  double roll = 0.0, pitch = 0.0;
  double roll_change = 0.0, pitch_change = 0.0;  // [rad/s]
  double elapsed = 0.0;                          // share of the drive, scaled to -1..1
  double voltage = 0.0;         // relative drop since the beginning; 0 = not measured
  double inner = 0.0;           // [m/s] of the inner track in the direction of the outer one
  TrackCommand command;         // mean during the observation
  TrackCommand command_before;  // mean over kBefore before it
  double since_command = 0.0;   // [s] since the last change of command, at most kLongSince
  Past past;
};

Twist2 meanTwist(const std::vector<MotionSample>& motion, double from, double to) {
  return twistTo(between(poseAt(motion, from), poseAt(motion, to)), to - from);
}

/// The newest reading of roll and pitch; nullptr if there is none.
const InsSample* attitudeAt(const Segment& segment, double time) {
  auto ins = std::upper_bound(segment.ins.begin(), segment.ins.end(), time,
                              [](double t, const InsSample& sample) { return t < sample.time; });
  while (ins != segment.ins.begin() && !std::isfinite(std::prev(ins)->roll)) --ins;
  return ins == segment.ins.begin() ? nullptr : &*std::prev(ins);
}

double voltageDrop(const std::vector<VoltageSample>& voltage, double time) {
  if (voltage.empty() || voltage.front().voltage <= 0.0) return 0.0;
  auto after =
      std::upper_bound(voltage.begin(), voltage.end(), time,
                       [](double t, const VoltageSample& sample) { return t < sample.time; });
  if (after != voltage.begin()) --after;
  return 1.0 - after->voltage / voltage.front().voltage;
}

using Commands = std::vector<CommandSample>;

/// The first command after a time.
Commands::const_iterator commandAfter(const Commands& commands, double time) {
  return std::upper_bound(commands.begin(), commands.end(), time,
                          [](double t, const CommandSample& sample) { return t < sample.time; });
}

TrackCommand meanCommand(const Drive& drive, const Segment& segment, double from, double to) {
  auto next = commandAfter(segment.commands, from);
  TrackCommand now = drive.sides(next == segment.commands.begin() ? segment.command_before
                                                                  : std::prev(next)->command);
  TrackCommand sum{0.0, 0.0};
  for (double time = from; time < to;) {
    const bool changes = next != segment.commands.end() && next->time < to;
    const double until = changes ? next->time : to;
    sum.left += now.left * (until - time);
    sum.right += now.right * (until - time);
    time = until;
    if (changes) now = drive.sides((next++)->command);
  }
  return {sum.left / (to - from), sum.right / (to - from)};
}

double sinceCommand(const Segment& segment, double time) {
  auto at = commandAfter(segment.commands, time);
  while (at != segment.commands.begin()) {
    const CommandSample& sample = *--at;
    if (time - sample.time >= kLongSince) break;
    const Command& before =
        at == segment.commands.begin() ? segment.command_before : std::prev(at)->command;
    if (before != sample.command) return time - sample.time;
  }
  return kLongSince;
}

/// Command of the inner track, in the direction of the outer one.
double innerOf(const TrackCommand& command) {
  const bool left_is_inner = std::abs(command.left) < std::abs(command.right);
  const double inner = left_is_inner ? command.left : command.right;
  const double outer = left_is_inner ? command.right : command.left;
  return outer < 0.0 ? -inner : inner;
}

Conditions conditionsOf(const Observations& data, const Observation& row, double gauge,
                        const std::vector<MotionSample>& motion, const std::vector<Past>& past) {
  const Drive& drive = data.drives()[row.drive];
  const Segment& segment = drive.segments[row.segment];
  Conditions conditions;
  const Twist2 now = meanTwist(motion, row.begin, row.end);
  conditions.v = now.v_x;
  conditions.omega = now.omega;
  const double back = std::max(segment.begin(), row.begin - kBack);
  if (row.begin - back > 0.1) {
    const Twist2 before = meanTwist(motion, back, row.begin);
    conditions.v_change = (now.v_x - before.v_x) / kBack;
    conditions.speed_change = (std::abs(now.v_x) - std::abs(before.v_x)) / kBack;
    conditions.omega_change = (now.omega - before.omega) / kBack;
  }
  const double begin = drive.segments.front().begin();
  const double end = drive.segments.back().end;
  conditions.elapsed = 2.0 * ((row.begin - begin) / std::max(1.0, end - begin)) - 1.0;
  const double middle = (row.begin + row.end) / 2.0;
  const InsSample* attitude = attitudeAt(segment, middle);
  const InsSample* earlier = attitudeAt(segment, middle - kBack);
  if (attitude != nullptr) {
    conditions.roll = attitude->roll;
    conditions.pitch = attitude->pitch;
  }
  if (earlier != nullptr && attitude != nullptr && attitude != earlier) {
    const double dt = attitude->time - earlier->time;
    conditions.roll_change = (attitude->roll - earlier->roll) / dt;
    conditions.pitch_change = (attitude->pitch - earlier->pitch) / dt;
  }
  conditions.voltage = voltageDrop(drive.voltage, middle);
  conditions.inner = std::abs(now.v_x) - 0.5 * gauge * std::abs(now.omega);
  conditions.command = meanCommand(drive, segment, row.begin, row.end);
  conditions.command_before = meanCommand(drive, segment, row.begin - kBefore, row.begin);
  conditions.since_command = sinceCommand(segment, row.begin);
  const auto sample =
      std::upper_bound(motion.begin(), motion.end(), row.begin,
                       [](double time, const MotionSample& one) { return time < one.time; });
  if (sample != motion.begin())
    conditions.past = past[static_cast<size_t>(std::distance(motion.begin(), sample)) - 1];
  return conditions;
}

struct Basis {
  const char* name;
  const char* unit;
  double (*value)(const Conditions&);
};

double signOf(double value) {
  return std::tanh(value / 0.05);
}

const std::vector<Basis>& bases() {
  static const std::vector<Basis> all{
      {"constant", "1", [](const Conditions&) { return 1.0; }},
      {"v", "m/s", [](const Conditions& m) { return m.v; }},
      {"yaw rate", "rad/s", [](const Conditions& m) { return m.omega; }},
      {"v^2", "m2/s2", [](const Conditions& m) { return m.v * m.v; }},
      {"v |v|", "m2/s2", [](const Conditions& m) { return m.v * std::abs(m.v); }},
      {"yaw rate |yaw rate|", "rad2/s2",
       [](const Conditions& m) { return m.omega * std::abs(m.omega); }},
      {"yaw rate^2", "rad2/s2", [](const Conditions& m) { return m.omega * m.omega; }},
      {"v x yaw rate", "m/s2", [](const Conditions& m) { return m.v * m.omega; }},
      {"|v|", "m/s", [](const Conditions& m) { return std::abs(m.v); }},
      {"|yaw rate|", "rad/s", [](const Conditions& m) { return std::abs(m.omega); }},
      {"|v| x yaw rate", "m/s2", [](const Conditions& m) { return std::abs(m.v) * m.omega; }},
      {"v |yaw rate|", "m/s2", [](const Conditions& m) { return m.v * std::abs(m.omega); }},
      {"v^2 x yaw rate", "m2/s3", [](const Conditions& m) { return m.v * m.v * m.omega; }},
      {"sign of v", "1", [](const Conditions& m) { return signOf(m.v); }},
      {"sign of yaw rate", "1", [](const Conditions& m) { return signOf(m.omega); }},
      {"v x elapsed time", "m/s", [](const Conditions& m) { return m.v * m.elapsed; }},
      {"yaw rate x elapsed time", "rad/s", [](const Conditions& m) { return m.omega * m.elapsed; }},
      {"change of v", "m/s2", [](const Conditions& m) { return m.v_change; }},
      {"change of yaw rate", "rad/s2", [](const Conditions& m) { return m.omega_change; }},
      {"|change of v|", "m/s2", [](const Conditions& m) { return std::abs(m.v_change); }},
      {"|change of yaw rate|", "rad/s2",
       [](const Conditions& m) { return std::abs(m.omega_change); }},
      {"yaw rate x change of v", "m/s3", [](const Conditions& m) { return m.omega * m.v_change; }},
      {"v x change of yaw rate", "m/s3", [](const Conditions& m) { return m.v * m.omega_change; }},
      {"yaw rate x change of |v|", "m/s3",
       [](const Conditions& m) { return m.omega * m.speed_change; }},
      {"|yaw rate| x turns before", "rad/s",
       [](const Conditions& m) { return std::abs(m.omega) * m.past.turned; }},
      {"turns before", "1", [](const Conditions& m) { return m.past.turned; }},
      {"sign of v, just reversed", "1",
       [](const Conditions& m) { return signOf(m.v) * m.past.reversed; }},
      {"sign of v, just set off", "1",
       [](const Conditions& m) { return signOf(m.v) * m.past.rested; }},
      {"sign of yaw rate, just set off", "1",
       [](const Conditions& m) { return signOf(m.omega) * m.past.rested; }},
      {"sign of v x |change of v|", "m/s2",
       [](const Conditions& m) { return signOf(m.v) * std::abs(m.v_change); }},
      {"sign of yaw rate x |change of yaw rate|", "rad/s2",
       [](const Conditions& m) { return signOf(m.omega) * std::abs(m.omega_change); }},
      {"sign of the inner track x yaw rate", "rad/s",
       [](const Conditions& m) { return signOf(m.inner) * m.omega; }},
      {"v x voltage drop", "m/s", [](const Conditions& m) { return m.v * m.voltage; }},
      {"yaw rate x voltage drop", "rad/s", [](const Conditions& m) { return m.omega * m.voltage; }},
      {"change of v x voltage drop", "m/s2",
       [](const Conditions& m) { return m.v_change * m.voltage; }},
      {"change of yaw rate x voltage drop", "rad/s2",
       [](const Conditions& m) { return m.omega_change * m.voltage; }},
      {"change of v x elapsed time", "m/s2",
       [](const Conditions& m) { return m.v_change * m.elapsed; }},
      {"change of yaw rate x elapsed time", "rad/s2",
       [](const Conditions& m) { return m.omega_change * m.elapsed; }},
      {"pitch", "rad", [](const Conditions& m) { return std::sin(m.pitch); }},
      {"roll", "rad", [](const Conditions& m) { return std::sin(m.roll); }},
      {"change of pitch", "rad/s", [](const Conditions& m) { return m.pitch_change; }},
      {"change of roll", "rad/s", [](const Conditions& m) { return m.roll_change; }}};
  return all;
}

double forward(const TrackCommand& command) {
  return 0.5 * (command.left + command.right);
}

double turning(const TrackCommand& command) {
  return 0.5 * (command.right - command.left);
}

/// Inputs for dependences of unknown form; speed and yaw rate first.
const std::vector<Basis>& inputs() {
  static const std::vector<Basis> all{
      {"v", "m/s", [](const Conditions& m) { return m.v; }},
      {"yaw rate", "rad/s", [](const Conditions& m) { return m.omega; }},
      {"change of v", "m/s2", [](const Conditions& m) { return m.v_change; }},
      {"change of yaw rate", "rad/s2", [](const Conditions& m) { return m.omega_change; }},
      {"roll", "rad", [](const Conditions& m) { return m.roll; }},
      {"pitch", "rad", [](const Conditions& m) { return m.pitch; }},
      {"elapsed time", "1", [](const Conditions& m) { return m.elapsed; }},
      {"voltage drop", "1", [](const Conditions& m) { return m.voltage; }},
      {"turns before", "1", [](const Conditions& m) { return m.past.turned; }},
      {"just reversed", "1", [](const Conditions& m) { return m.past.reversed; }},
      {"just set off", "1", [](const Conditions& m) { return m.past.rested; }},
      {"forward command", "1", [](const Conditions& m) { return forward(m.command); }},
      {"turning command", "1", [](const Conditions& m) { return turning(m.command); }},
      {"forward command before", "1",
       [](const Conditions& m) { return forward(m.command_before); }},
      {"turning command before", "1",
       [](const Conditions& m) { return turning(m.command_before); }},
      {"time since the command", "s", [](const Conditions& m) { return m.since_command; }},
      {"command of the inner track", "1", [](const Conditions& m) { return innerOf(m.command); }},
      {"speed of the inner track", "m/s", [](const Conditions& m) { return m.inner; }}};
  return all;
}

std::vector<Conditions> allConditions(const Observations& data, const ModelDocument& model) {
  const auto motions = data.simulate(model.vehicle);
  std::vector<std::vector<Past>> pasts;
  for (const std::vector<MotionSample>& motion : motions) pasts.push_back(pastOf(motion));
  std::vector<Conditions> conditions;
  conditions.reserve(data.all().size());
  for (const Observation& row : data.all()) {
    const size_t at = data.segmentIndex(row.drive, row.segment);
    conditions.push_back(conditionsOf(data, row, model.vehicle.gauge, motions[at], pasts[at]));
  }
  return conditions;
}

std::vector<Variable> valuesOf(const std::vector<Basis>& of, const Observations& data,
                               const ModelDocument& model) {
  const std::vector<Conditions> conditions = allConditions(data, model);
  std::vector<Variable> variables;
  for (const Basis& basis : of) {
    Variable variable{basis.name, basis.unit, Eigen::VectorXd(conditions.size())};
    for (size_t i = 0; i < conditions.size(); ++i)
      variable.values[static_cast<Eigen::Index>(i)] = basis.value(conditions[i]);
    variables.push_back(std::move(variable));
  }
  return variables;
}

}  // namespace

std::vector<Variable> variablesOf(const Observations& data, const ModelDocument& model) {
  return valuesOf(bases(), data, model);
}

std::vector<Variable> inputsOf(const Observations& data, const ModelDocument& model) {
  return valuesOf(inputs(), data, model);
}

}  // namespace tread::gap
