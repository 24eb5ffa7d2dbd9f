// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/gap/plan_rival.hpp"

#include <algorithm>
#include <cmath>

namespace tread::gap {
namespace {

constexpr size_t kSamples = 10;  // commands between two observations: half a second

/// Half an hour into a session: what grows with time is there, but constant.
Circumstances circumstances() {
  Circumstances late;
  late.session_time = 1800.0;
  late.worked = 0.5;
  return late;
}

ExecutionSpread spreadOf(const VehicleModel& vehicle) {
  ExecutionSpread spread = vehicle.spread;
  if (spread.forward <= 0.0) spread.forward = 0.03;
  if (spread.yaw <= 0.0) spread.yaw = 0.03;
  if (spread.crab <= 0.0) spread.crab = 0.017;
  return spread;
}

/// Pose and mean yaw rate of each half second, one below the other.
Eigen::VectorXd observed(const ModelDocument& model, const Manoeuvre& manoeuvre,
                         const ExecutionNoise& noise = {}) {
  const std::vector<MotionSample> motion = drivenByModel(model, manoeuvre, circumstances(), noise);
  std::vector<double> values;
  double turned = 0.0;
  size_t held = 0;
  for (size_t i = 1; i < motion.size(); ++i) {
    turned += 0.5 * (motion[i - 1].omega + motion[i].omega);
    ++held;
    if (i % kSamples != 0 && i + 1 != motion.size()) continue;
    const Pose2& pose = motion[i].T_map_body;
    values.insert(values.end(), {pose.x, pose.y, pose.yaw, turned / static_cast<double>(held)});
    turned = 0.0;
    held = 0;
  }
  return Eigen::Map<Eigen::VectorXd>(values.data(), static_cast<Eigen::Index>(values.size()));
}

/// What an error of the pose at the begin does to all later ones.
Eigen::MatrixXd startErrors(const Eigen::VectorXd& values, const InsNoise& noise) {
  Eigen::MatrixXd columns = Eigen::MatrixXd::Zero(values.size(), 3);
  for (Eigen::Index i = 0; i + 3 < values.size(); i += 4) {
    columns(i, 0) = noise.fix;
    columns(i + 1, 1) = noise.fix;
    columns(i, 2) = -values[i + 1] * noise.heading;
    columns(i + 1, 2) = values[i] * noise.heading;
    columns(i + 2, 2) = noise.heading;
  }
  return columns;
}

Eigen::MatrixXd noiseOf(const ModelDocument& model, const Manoeuvre& manoeuvre,
                        const Eigen::VectorXd& mean, const InsNoise& ins) {
  const ExecutionSpread spread = spreadOf(model.vehicle);
  const ExecutionNoise along{1.0 + spread.forward, 1.0, 0.0};
  const ExecutionNoise turning{1.0, 1.0 + spread.yaw, 0.0};
  const ExecutionNoise across{1.0, 1.0, spread.crab};
  Eigen::VectorXd own(mean.size());
  for (Eigen::Index i = 0; i < own.size(); ++i)
    own[i] = i % 4 < 2 ? ins.fix : i % 4 == 2 ? ins.heading : ins.gyro;
  Eigen::MatrixXd covariance = own.array().square().matrix().asDiagonal();
  for (const ExecutionNoise& noise : {along, turning, across}) {
    const Eigen::VectorXd change = observed(model, manoeuvre, noise) - mean;
    covariance += change * change.transpose();
  }
  const Eigen::MatrixXd start = startErrors(mean, ins);
  return covariance + start * start.transpose();
}

}  // namespace

Probe::Probe(const ModelDocument& truth, const Manoeuvre& manoeuvre, const InsNoise& ins)
    : manoeuvre_(manoeuvre),
      wanted_(observed(truth, manoeuvre)),
      noise_(noiseOf(truth, manoeuvre, wanted_, ins)) {}

Eigen::VectorXd Probe::missed(const ModelDocument& model) const {
  return noise_.matrixL().solve(observed(model, manoeuvre_) - wanted_);
}

double Probe::duration() const {
  return kManoeuvrePeriod * static_cast<double>(manoeuvre_.commands.size());
}

double Rival::fit(const std::vector<Probe>& probes, const std::vector<size_t>& counts) {
  constexpr int kIterations = 12;
  constexpr double kStuck = 1e6;
  double damping = 1e-3;
  double loss = lossOf(model_, probes, counts);
  for (int i = 0; i < kIterations && damping < kStuck; ++i) {
    Eigen::MatrixXd information;
    Eigen::VectorXd pull;
    linearise(probes, counts, information, pull);
    const double before = loss;
    while (damping < kStuck && !step(information, pull, damping, probes, counts, loss))
      damping *= 10.0;
    damping *= 0.1;
    if (before - loss < 1e-6 * (1.0 + before)) break;
  }
  return loss;
}

double Rival::priorLoss(const ModelDocument& model) const {
  double sum = 0.0;
  for (const FreeParameter& parameter : free_) {
    const double off = *findParameter(model, parameter.path) - parameter.expected;
    if (std::isfinite(parameter.deviation)) sum += 0.5 * std::pow(off / parameter.deviation, 2);
  }
  return sum;
}

double Rival::lossOf(const ModelDocument& model, const std::vector<Probe>& probes,
                     const std::vector<size_t>& counts) const {
  double sum = priorLoss(model);
  for (size_t i = 0; i < probes.size(); ++i)
    if (counts[i] > 0)
      sum += 0.5 * static_cast<double>(counts[i]) * probes[i].missed(model).squaredNorm();
  return sum;
}

Eigen::MatrixXd Rival::columnsOf(const Probe& probe, const Eigen::VectorXd& missed) const {
  Eigen::MatrixXd columns(missed.size(), static_cast<Eigen::Index>(free_.size()));
  for (size_t j = 0; j < free_.size(); ++j) {
    ModelDocument moved = model_;
    double& value = *findParameter(moved, free_[j].path);
    const double by = value + free_[j].step <= free_[j].max ? free_[j].step : -free_[j].step;
    value += by;
    columns.col(static_cast<Eigen::Index>(j)) = (probe.missed(moved) - missed) / by;
  }
  return columns;
}

void Rival::linearise(const std::vector<Probe>& probes, const std::vector<size_t>& counts,
                      Eigen::MatrixXd& information, Eigen::VectorXd& pull) const {
  const auto size = static_cast<Eigen::Index>(free_.size());
  information = Eigen::MatrixXd::Zero(size, size);
  pull = Eigen::VectorXd::Zero(size);
  for (size_t i = 0; i < probes.size(); ++i) {
    if (counts[i] == 0) continue;
    const auto times = static_cast<double>(counts[i]);
    const Eigen::VectorXd missed = probes[i].missed(model_);
    const Eigen::MatrixXd columns = columnsOf(probes[i], missed);
    information += times * columns.transpose() * columns;
    pull += times * columns.transpose() * missed;
  }
  for (size_t j = 0; j < free_.size(); ++j) {
    if (!std::isfinite(free_[j].deviation)) continue;
    const auto at = static_cast<Eigen::Index>(j);
    const double precision = 1.0 / (free_[j].deviation * free_[j].deviation);
    information(at, at) += precision;
    pull[at] += precision * (*findParameter(model_, free_[j].path) - free_[j].expected);
  }
}

/// One damped step; false if it does not help.
bool Rival::step(const Eigen::MatrixXd& information, const Eigen::VectorXd& pull, double damping,
                 const std::vector<Probe>& probes, const std::vector<size_t>& counts,
                 double& loss) {
  Eigen::MatrixXd damped = information;
  for (size_t j = 0; j < free_.size(); ++j) {
    const auto at = static_cast<Eigen::Index>(j);
    damped(at, at) += damping * damped(at, at) + 1e-12 / (free_[j].step * free_[j].step);
  }
  const Eigen::VectorXd change = damped.ldlt().solve(-pull);
  ModelDocument moved = model_;
  for (size_t j = 0; j < free_.size(); ++j) {
    double& value = *findParameter(moved, free_[j].path);
    value = std::clamp(value + change[static_cast<Eigen::Index>(j)], free_[j].min, free_[j].max);
  }
  const double tried = lossOf(moved, probes, counts);
  if (!(tried < loss)) return false;
  loss = tried;
  model_ = moved;
  return true;
}

}  // namespace tread::gap
