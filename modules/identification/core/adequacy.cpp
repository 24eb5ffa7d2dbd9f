// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/adequacy.hpp"

#include <algorithm>
#include <cmath>
#include <functional>

#include "modules/identification/core/score_test.hpp"

namespace tread::gap {
namespace {

constexpr int kDraws = 1999;
constexpr double kBack = 0.5;  // [s] before a row, for what came before it

/// What goes on in one row.
struct Moment {
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

Moment momentOf(const Rows& rows, const Row& row, const std::vector<MotionSample>& motion) {
  const Drive& drive = rows.drives()[row.drive];
  const Stretch& stretch = drive.stretches[row.stretch];
  Moment moment;
  const Twist2 now = meanTwist(motion, row.begin, row.end);
  moment.v = now.v_x;
  moment.omega = now.omega;
  const double back = std::max(stretch.begin(), row.begin - kBack);
  if (row.begin - back > 0.1) {
    const Twist2 before = meanTwist(motion, back, row.begin);
    moment.v_change = (now.v_x - before.v_x) / kBack;
    moment.omega_change = (now.omega - before.omega) / kBack;
  }
  const double begin = drive.stretches.front().begin();
  const double end = drive.stretches.back().end;
  moment.elapsed = 2.0 * ((row.begin - begin) / std::max(1.0, end - begin)) - 1.0;
  auto ins =
      std::upper_bound(stretch.ins.begin(), stretch.ins.end(), (row.begin + row.end) / 2.0,
                       [](double time, const InsSample& sample) { return time < sample.time; });
  while (ins != stretch.ins.begin() && !std::isfinite(std::prev(ins)->roll)) --ins;
  if (ins != stretch.ins.begin()) {
    moment.roll = std::prev(ins)->roll;
    moment.pitch = std::prev(ins)->pitch;
  }
  return moment;
}

struct Basis {
  const char* name;
  const char* unit;
  double (*value)(const Moment&);
};

double signOf(double value) {
  return std::tanh(value / 0.05);
}

const std::vector<Basis>& bases() {
  static const std::vector<Basis> all{
      {"constant", "1", [](const Moment&) { return 1.0; }},
      {"v", "m/s", [](const Moment& m) { return m.v; }},
      {"yaw rate", "rad/s", [](const Moment& m) { return m.omega; }},
      {"v^2", "m2/s2", [](const Moment& m) { return m.v * m.v; }},
      {"v |v|", "m2/s2", [](const Moment& m) { return m.v * std::abs(m.v); }},
      {"yaw rate |yaw rate|", "rad2/s2",
       [](const Moment& m) { return m.omega * std::abs(m.omega); }},
      {"yaw rate^2", "rad2/s2", [](const Moment& m) { return m.omega * m.omega; }},
      {"v x yaw rate", "m/s2", [](const Moment& m) { return m.v * m.omega; }},
      {"|v|", "m/s", [](const Moment& m) { return std::abs(m.v); }},
      {"|yaw rate|", "rad/s", [](const Moment& m) { return std::abs(m.omega); }},
      {"|v| x yaw rate", "m/s2", [](const Moment& m) { return std::abs(m.v) * m.omega; }},
      {"v |yaw rate|", "m/s2", [](const Moment& m) { return m.v * std::abs(m.omega); }},
      {"v^2 x yaw rate", "m2/s3", [](const Moment& m) { return m.v * m.v * m.omega; }},
      {"sign of v", "1", [](const Moment& m) { return signOf(m.v); }},
      {"sign of yaw rate", "1", [](const Moment& m) { return signOf(m.omega); }},
      {"v x elapsed time", "m/s", [](const Moment& m) { return m.v * m.elapsed; }},
      {"yaw rate x elapsed time", "rad/s", [](const Moment& m) { return m.omega * m.elapsed; }},
      {"change of v", "m/s2", [](const Moment& m) { return m.v_change; }},
      {"change of yaw rate", "rad/s2", [](const Moment& m) { return m.omega_change; }},
      {"|change of v|", "m/s2", [](const Moment& m) { return std::abs(m.v_change); }},
      {"|change of yaw rate|", "rad/s2", [](const Moment& m) { return std::abs(m.omega_change); }},
      {"yaw rate x change of v", "m/s3", [](const Moment& m) { return m.omega * m.v_change; }},
      {"v x change of yaw rate", "m/s3", [](const Moment& m) { return m.v * m.omega_change; }},
      {"pitch", "rad", [](const Moment& m) { return std::sin(m.pitch); }},
      {"roll", "rad", [](const Moment& m) { return std::sin(m.roll); }}};
  return all;
}

std::vector<Moment> momentsOf(const Rows& rows, const ModelDocument& model) {
  const auto motions = rows.simulate(model.vehicle);
  std::vector<Moment> moments;
  moments.reserve(rows.rows().size());
  for (const Row& row : rows.rows())
    moments.push_back(momentOf(rows, row, motions[rows.stretchIndex(row.drive, row.stretch)]));
  return moments;
}

/// Each variable in the rows of one channel only, for every channel.
Eigen::MatrixXd perChannel(const Rows& rows, const std::vector<Variable>& variables) {
  const auto count = static_cast<Eigen::Index>(variables.size());
  Eigen::MatrixXd directions = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(rows.rows().size()),
                                                     count * static_cast<Eigen::Index>(kChannels));
  for (size_t i = 0; i < rows.rows().size(); ++i)
    for (Eigen::Index v = 0; v < count; ++v) {
      const auto row = static_cast<Eigen::Index>(i);
      const auto channel = static_cast<Eigen::Index>(rows.rows()[i].channel);
      directions(row, channel * count + v) = variables[static_cast<size_t>(v)].values[row];
    }
  return directions;
}

}  // namespace

std::vector<Variable> variablesOf(const Rows& rows, const ModelDocument& model) {
  const std::vector<Moment> moments = momentsOf(rows, model);
  std::vector<Variable> variables;
  for (const Basis& basis : bases()) {
    Variable variable{basis.name, basis.unit, Eigen::VectorXd(moments.size())};
    for (size_t i = 0; i < moments.size(); ++i)
      variable.values[static_cast<Eigen::Index>(i)] = basis.value(moments[i]);
    variables.push_back(std::move(variable));
  }
  return variables;
}

Adequacy testAdequacy(const Fitter& fitter, const FitState& state, const std::vector<char>& mask,
                      double alpha, uint64_t seed) {
  const std::vector<Variable> variables = variablesOf(fitter.rows(), state.model);
  const ScoreTest test(fitter.rows(), state, perChannel(fitter.rows(), variables), mask);
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
