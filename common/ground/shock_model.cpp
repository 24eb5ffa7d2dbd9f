// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/ground/shock_model.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>
#include <Eigen/LU>

namespace tread {
namespace {

constexpr double kUnit = 0.01;                          // roughness whose logarithm is 0 [m]
constexpr double kSmoothest = 0.0005, kRoughest = 0.2;  // [m]
constexpr double kSlowest = 0.05, kFastest = 20.0;      // [m/s]
/// Weight of the variance's prior, in pairs.
constexpr double kPriorPairs = 6.0;
/// Upper limit of the uncertainty, because otherwise one wild estimate would forbid all ground [1].
constexpr double kMostVariance = 0.6;

Eigen::Vector3d inputOf(double roughness, double speed) {
  return {1.0, std::log(std::clamp(roughness, kSmoothest, kRoughest) / kUnit),
          std::log(std::clamp(std::abs(speed), kSlowest, kFastest))};
}

/// Of a lognormal variable s: E[s^2] = exp(2 mu + 2 sigma^2).
double meanSquareOf(double mu, double variance) {
  return std::exp(2.0 * mu + 2.0 * std::min(kMostVariance, variance));
}

}  // namespace

double ShockModel::meanSquare(double roughness, double speed) const {
  const Eigen::Vector3d x = inputOf(roughness, speed);
  return meanSquareOf(mean.dot(x), variance + x.dot(covariance * x));
}

double ShockModel::meanSquareLike(double shock, double speed) const {
  const double log_speed = inputOf(kUnit, speed)[2];
  return meanSquareOf(std::log(shock) + mean[2] * log_speed,
                      variance + covariance(2, 2) * log_speed * log_speed);
}

double ShockModel::speedFactor(double speed) const {
  return std::exp(mean[2] * inputOf(kUnit, speed)[2]);
}

void ShockRegression::learn(double roughness, double speed, double shock) {
  if (!(roughness > 0.0 && speed > 0.0 && shock > 0.0) || !std::isfinite(roughness + speed + shock))
    return;
  const Eigen::Vector3d x = inputOf(roughness, speed);
  const double y = std::log(shock);
  constexpr double kKept = 1.0 - 1.0 / kMemory;
  inputs_ = kKept * inputs_ + x * x.transpose();
  products_ = kKept * products_ + y * x;
  squares_ = kKept * squares_ + y * y;
  weight_ = kKept * weight_ + 1.0;
  ++pairs_;
}

std::vector<double> ShockRegression::state() const {
  std::vector<double> numbers;
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) numbers.push_back(inputs_(i, j));
  for (int i = 0; i < 3; ++i) numbers.push_back(products_[i]);
  numbers.insert(numbers.end(), {squares_, weight_, static_cast<double>(pairs_)});
  return numbers;
}

std::optional<ShockRegression> ShockRegression::fromState(const std::vector<double>& numbers) {
  if (numbers.size() != kNumbers) return std::nullopt;
  for (const double number : numbers)
    if (!std::isfinite(number)) return std::nullopt;
  ShockRegression regression;
  size_t at = 0;
  for (int i = 0; i < 3; ++i)
    for (int j = i; j < 3; ++j) regression.inputs_(i, j) = regression.inputs_(j, i) = numbers[at++];
  for (int i = 0; i < 3; ++i) regression.products_[i] = numbers[at++];
  regression.squares_ = numbers[9];
  regression.weight_ = numbers[10];
  regression.pairs_ = static_cast<int>(std::clamp(numbers[11], 0.0, 1e9));
  const bool possible = regression.inputs_.diagonal().minCoeff() >= 0.0 &&
                        regression.squares_ >= 0.0 &&
                        std::abs(regression.inputs_(0, 0) - regression.weight_) < 1e-6;
  if (!possible) return std::nullopt;
  return regression;
}

ShockModel ShockRegression::model() const {
  const ShockModel prior;
  // Normal-inverse-gamma posterior (Bishop, Pattern Recognition and Machine Learning, 3.3 and
  // exercise 3.12); precisions are in units of 1 / variance.
  const Eigen::Matrix3d prior_precision = prior.variance * prior.covariance.inverse();
  const Eigen::Matrix3d precision = prior_precision + inputs_;
  const Eigen::LDLT<Eigen::Matrix3d> solver(precision);
  ShockModel model;
  model.mean = solver.solve(prior_precision * prior.mean + products_);
  const double residual = squares_ + prior.mean.dot(prior_precision * prior.mean) -
                          model.mean.dot(precision * model.mean);
  model.variance =
      (kPriorPairs * prior.variance + std::max(0.0, residual)) / (kPriorPairs + weight_);
  model.covariance = model.variance * solver.solve(Eigen::Matrix3d::Identity());
  return model;
}

}  // namespace tread
