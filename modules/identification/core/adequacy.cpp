// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/adequacy.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "modules/identification/core/validation.hpp"

namespace tread::gap {
namespace {

constexpr int kDraws = 1999;
constexpr double kBack = 0.5;  // [s] before an observation, for the motion just before it

/// How the vehicle moves during one observation.
struct Conditions {
  double v = 0.0;         // [m/s]
  double omega = 0.0;     // [rad/s]
  double v_change = 0.0;  // [m/s2] against just before
  double omega_change = 0.0;
  double roll = 0.0;
  double pitch = 0.0;
  double elapsed = 0.0;  // share of the drive, -1..1
};

Twist2 meanTwist(const std::vector<MotionSample>& motion, double from, double to) {
  return twistTo(between(poseAt(motion, from), poseAt(motion, to)), to - from);
}

Conditions conditionsOf(const Observations& data, const Observation& row,
                        const std::vector<MotionSample>& motion) {
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
    conditions.omega_change = (now.omega - before.omega) / kBack;
  }
  const double begin = drive.segments.front().begin();
  const double end = drive.segments.back().end;
  conditions.elapsed = 2.0 * ((row.begin - begin) / std::max(1.0, end - begin)) - 1.0;
  auto ins =
      std::upper_bound(segment.ins.begin(), segment.ins.end(), (row.begin + row.end) / 2.0,
                       [](double time, const InsSample& sample) { return time < sample.time; });
  while (ins != segment.ins.begin() && !std::isfinite(std::prev(ins)->roll)) --ins;
  if (ins != segment.ins.begin()) {
    conditions.roll = std::prev(ins)->roll;
    conditions.pitch = std::prev(ins)->pitch;
  }
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
      {"pitch", "rad", [](const Conditions& m) { return std::sin(m.pitch); }},
      {"roll", "rad", [](const Conditions& m) { return std::sin(m.roll); }}};
  return all;
}

std::vector<Conditions> allConditions(const Observations& data, const ModelDocument& model) {
  const auto motions = data.simulate(model.vehicle);
  std::vector<Conditions> conditions;
  conditions.reserve(data.all().size());
  for (const Observation& row : data.all())
    conditions.push_back(
        conditionsOf(data, row, motions[data.segmentIndex(row.drive, row.segment)]));
  return conditions;
}

/// Each variable in the rows of one channel only, for every channel.
Eigen::MatrixXd perChannel(const Observations& data, const std::vector<Variable>& variables) {
  const auto count = static_cast<Eigen::Index>(variables.size());
  Eigen::MatrixXd directions = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(data.all().size()),
                                                     count * static_cast<Eigen::Index>(kChannels));
  for (size_t i = 0; i < data.all().size(); ++i)
    for (Eigen::Index v = 0; v < count; ++v) {
      const auto row = static_cast<Eigen::Index>(i);
      const auto channel = static_cast<Eigen::Index>(data.all()[i].channel);
      directions(row, channel * count + v) = variables[static_cast<size_t>(v)].values[row];
    }
  return directions;
}

}  // namespace

std::vector<Variable> variablesOf(const Observations& data, const ModelDocument& model) {
  const std::vector<Conditions> conditions = allConditions(data, model);
  std::vector<Variable> variables;
  for (const Basis& basis : bases()) {
    Variable variable{basis.name, basis.unit, Eigen::VectorXd(conditions.size())};
    for (size_t i = 0; i < conditions.size(); ++i)
      variable.values[static_cast<Eigen::Index>(i)] = basis.value(conditions[i]);
    variables.push_back(std::move(variable));
  }
  return variables;
}

Adequacy testAdequacy(const Fitter& fitter, const FitState& state, double alpha, uint64_t seed) {
  const std::vector<Variable> variables = variablesOf(fitter.data(), state.model);
  const ScoreTest test(fitter, state, perChannel(fitter.data(), variables));
  const std::vector<double> chance = test.largestByChance(kDraws, seed);
  Adequacy adequacy;
  for (size_t channel = 0; channel < kChannels; ++channel)
    for (size_t v = 0; v < variables.size(); ++v) {
      const auto at = static_cast<Eigen::Index>(channel * variables.size() + v);
      const double p = familyWise(chance, test.score(at));
      adequacy.p_value = std::min(adequacy.p_value, p);
      if (p <= alpha)
        adequacy.unexplained.push_back(
            {channelName(static_cast<Channel>(channel)), variables[v].name, test.score(at), p});
    }
  std::stable_sort(adequacy.unexplained.begin(), adequacy.unexplained.end(),
                   [](const Unexplained& a, const Unexplained& b) {
                     return std::abs(a.score) > std::abs(b.score);
                   });
  return adequacy;
}

}  // namespace tread::gap
