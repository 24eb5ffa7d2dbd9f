// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/validation.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Eigenvalues>

namespace tread::gap {
namespace {

constexpr int kFolds = 5;
constexpr int kRefits = 3;                 // iterated least squares steps of a linearised refit
constexpr double kLeastEigenvalue = 1e-7;  // of the normal matrix in units of its diagonal
constexpr double kUnknown = 1e12;

/// Fold of each row: whole blocks, counted among those that count.
std::vector<int> foldsOf(const Observations& data, const std::vector<char>& counts) {
  std::vector<int> fold_of_block(counts.size(), 0);
  int next = 0;
  for (size_t b = 0; b < counts.size(); ++b)
    if (counts[b]) fold_of_block[b] = next++ % kFolds;
  std::vector<int> folds;
  folds.reserve(data.all().size());
  for (const Observation& row : data.all())
    folds.push_back(fold_of_block[static_cast<size_t>(row.block)]);
  return folds;
}

Eigen::VectorXd values(const FitState& state, bool expected) {
  Eigen::VectorXd all(static_cast<Eigen::Index>(state.free.size()));
  for (size_t i = 0; i < state.free.size(); ++i)
    all[static_cast<Eigen::Index>(i)] =
        expected ? state.free[i].expected : *findParameter(state.model, state.free[i].path);
  return all;
}

/// Change of the parameters when only the rows of `train` count, in first order.
Eigen::VectorXd refitted(const FitState& state, const Eigen::VectorXd& residuals,
                         const std::vector<char>& train) {
  const Eigen::VectorXd prior = priorPrecision(state.free);
  const Eigen::VectorXd off = values(state, false) - values(state, true);
  Eigen::VectorXd change = Eigen::VectorXd::Zero(prior.size());
  Eigen::VectorXd now = residuals;
  for (int n = 0; n < kRefits; ++n) {
    Eigen::VectorXd weights(now.size());
    for (Eigen::Index i = 0; i < now.size(); ++i)
      weights[i] = train[static_cast<size_t>(i)] ? weightOf(now[i], state.scales[i]) : 0.0;
    const Eigen::MatrixXd weighted = weights.asDiagonal() * state.jacobian;
    Eigen::MatrixXd normal = state.jacobian.transpose() * weighted;
    normal.diagonal() += prior;
    normal.diagonal() *= 1.0 + 1e-9;
    for (Eigen::Index i = 0; i < normal.rows(); ++i)
      if (normal(i, i) <= 0.0) normal(i, i) = 1.0;
    const Eigen::VectorXd pull = weighted.transpose() * now - prior.cwiseProduct(off + change);
    const Eigen::VectorXd step = normal.ldlt().solve(pull);
    change += step;
    now -= state.jacobian * step;
  }
  return change;
}

}  // namespace

std::vector<char> blocksThatCount(const Observations& data, const std::vector<char>& mask) {
  std::vector<char> counts(static_cast<size_t>(data.blocks()), 0);
  for (size_t i = 0; i < mask.size(); ++i)
    if (mask[i]) counts[static_cast<size_t>(data.all()[i].block)] = 1;
  return counts;
}

Eigen::VectorXd heldOutLoss(const Observations& data, const FitState& state,
                            const std::vector<char>& mask) {
  const Eigen::VectorXd residuals = data.residuals(state.predicted);
  const std::vector<int> folds = foldsOf(data, blocksThatCount(data, mask));
  Eigen::VectorXd loss = Eigen::VectorXd::Zero(data.blocks());
  for (int fold = 0; fold < kFolds; ++fold) {
    std::vector<char> train(mask.size());
    for (size_t i = 0; i < mask.size(); ++i) train[i] = mask[i] && folds[i] != fold;
    Eigen::VectorXd outside = residuals;
    if (!state.free.empty()) outside -= state.jacobian * refitted(state, residuals, train);
    for (size_t i = 0; i < mask.size(); ++i)
      if (mask[i] && folds[i] == fold) {
        const auto at = static_cast<Eigen::Index>(i);
        loss[data.all()[i].block] += lossOf(outside[at], state.scales[at]);
      }
  }
  return loss;
}

void followLinearly(const Fitter& fitter, FitState& state, const std::vector<char>& mask) {
  if (state.free.empty()) return;
  const Eigen::VectorXd residuals = fitter.data().residuals(state.predicted);
  state.predicted += state.jacobian * refitted(state, residuals, mask);
}

Gain gainOf(const Eigen::VectorXd& first, const Eigen::VectorXd& second,
            const std::vector<char>& block_counts) {
  std::vector<double> gains;
  for (size_t b = 0; b < block_counts.size(); ++b)
    if (block_counts[b])
      gains.push_back(first[static_cast<Eigen::Index>(b)] - second[static_cast<Eigen::Index>(b)]);
  Gain gain;
  const auto count = static_cast<double>(gains.size());
  for (double value : gains) gain.value += value;
  if (gains.size() < 2) return gain;
  double squares = 0.0;
  for (double value : gains) squares += std::pow(value - gain.value / count, 2);
  gain.error = std::sqrt(squares * count / (count - 1.0));
  return gain;
}

Eigen::MatrixXd parameterCovariance(const Observations& data, const FitState& state,
                                    const std::vector<char>& mask) {
  const auto count = static_cast<Eigen::Index>(state.free.size());
  if (count == 0) return {};
  const Eigen::VectorXd residuals = data.residuals(state.predicted);
  Eigen::MatrixXd pulls = Eigen::MatrixXd::Zero(data.blocks(), count);
  Eigen::MatrixXd curvature = Eigen::MatrixXd::Zero(count, count);
  constexpr double kInformation = (kFreedom + 1.0) / (kFreedom + 3.0);
  Eigen::VectorXd metric = Eigen::VectorXd::Zero(residuals.size());
  for (Eigen::Index i = 0; i < residuals.size(); ++i) {
    if (!mask[static_cast<size_t>(i)]) continue;
    metric[i] = kInformation / (state.scales[i] * state.scales[i]);
    pulls.row(data.all()[static_cast<size_t>(i)].block) +=
        pullOf(residuals[i], state.scales[i]) * state.jacobian.row(i);
  }
  curvature = state.jacobian.transpose() * metric.asDiagonal() * state.jacobian;
  curvature.diagonal() += priorPrecision(state.free);
  Eigen::MatrixXd scatter = pulls.transpose() * pulls;
  scatter.diagonal() += priorPrecision(state.free);
  const auto counts = blocksThatCount(data, mask);
  const auto blocks = static_cast<double>(std::count(counts.begin(), counts.end(), char{1}));
  if (blocks > 1.0) scatter *= blocks / (blocks - 1.0);
  // In units of each diagonal, so that metres and seconds compare.
  Eigen::VectorXd unit(count);
  for (Eigen::Index i = 0; i < count; ++i)
    unit[i] = curvature(i, i) > 0.0 ? 1.0 / std::sqrt(curvature(i, i)) : 1.0;
  const Eigen::MatrixXd scaled = unit.asDiagonal() * curvature * unit.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
  Eigen::VectorXd inverse(count);
  Eigen::VectorXd lost = Eigen::VectorXd::Zero(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const bool known = eigen.eigenvalues()[i] > kLeastEigenvalue;
    inverse[i] = known ? 1.0 / eigen.eigenvalues()[i] : 0.0;
    if (!known) lost += eigen.eigenvectors().col(i).cwiseAbs2();
  }
  const Eigen::MatrixXd solved = unit.asDiagonal() * eigen.eigenvectors() * inverse.asDiagonal() *
                                 eigen.eigenvectors().transpose() * unit.asDiagonal();
  Eigen::MatrixXd covariance = solved * scatter * solved;
  for (Eigen::Index i = 0; i < count; ++i)
    if (lost[i] > 1e-3)
      covariance(i, i) += kUnknown * std::pow(state.free[static_cast<size_t>(i)].step, 2);
  return covariance;
}

}  // namespace tread::gap
