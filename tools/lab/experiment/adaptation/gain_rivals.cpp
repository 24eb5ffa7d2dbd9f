// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/experiment/adaptation/gain_rivals.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/LU>

namespace tread::adaptation {
namespace {

constexpr double kForgetting = 0.7;
constexpr double kMostVariance = 1.0;  // [1] without information on a gain P must not grow further
constexpr double kVelocityNoise = 0.003, kYawRateNoise = 0.008;  // [m/s], [rad/s]

constexpr double kChange = 0.1;  // probability that calm ground changes, and that a change ends
constexpr double kCalmWalk = 0.02;

std::vector<Twist2> scaled(std::vector<Twist2> twists, const Eigen::Vector3d& gains) {
  for (Twist2& twist : twists) {
    twist.v_x *= 1.0 + gains[0];
    twist.v_y *= 1.0 + gains[1];
    twist.omega *= 1.0 + gains[2];
  }
  return twists;
}

}  // namespace

GainRls::GainRls(Eigen::Index gains)
    : x_(Eigen::VectorXd::Zero(gains)),
      P_(kGainDeviation * kGainDeviation * Eigen::MatrixXd::Identity(gains, gains)) {}

void GainRls::learn(const Sample& sample) {
  const Eigen::Vector3d& m = sample.twist;
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(3, x_.size());
  if (x_.size() == 2) {
    H.col(0).head<2>() = m.head<2>();
    H(2, 1) = m[2];
  } else {
    H.diagonal() = m;
  }
  const Eigen::Vector3d noise(kVelocityNoise, kVelocityNoise, kYawRateNoise);
  if (P_.diagonal().maxCoeff() / kForgetting < kMostVariance) P_ /= kForgetting;
  const Eigen::Matrix3d S =
      H * P_ * H.transpose() + Eigen::Matrix3d(noise.cwiseAbs2().asDiagonal());
  const Eigen::MatrixXd K = P_ * H.transpose() * S.inverse();
  x_ += K * (sample.residual - H * x_);
  P_ -= (K * H * P_).eval();
}

std::vector<Twist2> GainRls::corrected(std::vector<Twist2> twists, const Sample&) const {
  const Eigen::Index last = x_.size() - 1;
  return scaled(std::move(twists), {x_[0], x_[last - 1], x_[last]});
}

InteractingGains::InteractingGains() {
  const Eigen::Matrix3d P = kGainDeviation * kGainDeviation * Eigen::Matrix3d::Identity();
  models_[0] = {1.0 - kChange, kCalmWalk, Eigen::Vector3d::Zero(), P};
  models_[1] = {kChange, kGainDeviation, Eigen::Vector3d::Zero(), P};
}

std::array<InteractingGains::Model, 2> InteractingGains::mixed() const {
  std::array<Model, 2> mixed = models_;
  for (size_t j = 0; j < 2; ++j) {
    std::array<double, 2> weights{};
    for (size_t i = 0; i < 2; ++i)
      weights[i] = (i == j ? 1.0 - kChange : kChange) * models_[i].probability;
    Model& model = mixed[j];
    model.probability = weights[0] + weights[1];
    model.x = (weights[0] * models_[0].x + weights[1] * models_[1].x) / model.probability;
    model.P = model.walk * model.walk * Eigen::Matrix3d::Identity();
    for (size_t i = 0; i < 2; ++i) {
      const Eigen::Vector3d apart = models_[i].x - model.x;
      model.P += weights[i] / model.probability * (models_[i].P + apart * apart.transpose());
    }
  }
  return mixed;
}

void InteractingGains::learn(const Sample& sample) {
  models_ = mixed();
  const Eigen::Matrix3d H = sample.twist.asDiagonal();
  std::array<double, 2> logs{};
  for (size_t j = 0; j < 2; ++j) {
    Model& model = models_[j];
    const Eigen::Matrix3d S = H * model.P * H + Eigen::Matrix3d(sample.noise.asDiagonal());
    const Eigen::Matrix3d inverse = S.inverse();
    const Eigen::Vector3d innovation = sample.residual - H * model.x;
    logs[j] = std::log(model.probability) - 0.5 * std::log(S.determinant()) -
              0.5 * innovation.dot(inverse * innovation);
    const Eigen::Matrix3d K = model.P * H * inverse;
    model.x += K * innovation;
    model.P -= (K * H * model.P).eval();
  }
  // Keep both models possible, so that the logarithm stays finite.
  const double calm = 1.0 / (1.0 + std::exp(logs[1] - logs[0]));
  models_[0].probability = std::clamp(calm, 1e-9, 1.0 - 1e-9);
  models_[1].probability = 1.0 - models_[0].probability;
}

Eigen::Vector3d InteractingGains::mean() const {
  return models_[0].probability * models_[0].x + models_[1].probability * models_[1].x;
}

std::vector<Twist2> InteractingGains::corrected(std::vector<Twist2> twists, const Sample&) const {
  return scaled(std::move(twists), mean());
}

std::unique_ptr<Rival> gainRival(const std::string& name) {
  if (name == "rls2") return std::make_unique<GainRls>(2);
  if (name == "rls3") return std::make_unique<GainRls>(3);
  if (name == "imm") return std::make_unique<InteractingGains>();
  return nullptr;
}

}  // namespace tread::adaptation
