// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/experiment/adaptation/rivals.hpp"

#include <algorithm>
#include <cmath>

namespace tread::adaptation {
namespace {

/// Standard deviations beyond which an innovation has linear influence (Huber), because poses may
/// jump.
constexpr double kHuber = 2.5;

/// Factor on a sample's variance, given its innovation y of variance S.
double inflation(double y, double S) {
  return std::max(1.0, std::abs(y) / (kHuber * std::sqrt(S)));
}

double logDensity(double y, double S) {
  const double sigmas = std::abs(y) / std::sqrt(S);
  const double loss = sigmas <= kHuber ? 0.5 * sigmas * sigmas : kHuber * (sigmas - 0.5 * kHuber);
  return -0.5 * std::log(2.0 * kPi * S) - loss;
}

double kernel(const KernelTuning& tuning, const Eigen::Vector2d& a, const Eigen::Vector2d& b) {
  const double squared = (a - b).cwiseQuotient(tuning.length).squaredNorm();
  return tuning.deviation * tuning.deviation * std::exp(-0.5 * squared);
}

double kernel(const KernelTuning& tuning, const Sample& a, const Eigen::Vector2d& b) {
  double sum = 0.0;
  for (const Eigen::Vector2d& part : a.speeds) sum += kernel(tuning, part, b);
  return sum / static_cast<double>(kParts);
}

double kernel(const KernelTuning& tuning, const Sample& a, const Sample& b) {
  double sum = 0.0;
  for (const Eigen::Vector2d& part : b.speeds) sum += kernel(tuning, a, part);
  return sum / static_cast<double>(kParts);
}

}  // namespace

LinearRival::LinearRival(size_t axis, Functions functions, const LinearTuning& tuning,
                         const Eigen::VectorXd& start)
    : axis_(static_cast<Eigen::Index>(axis)),
      functions_(std::move(functions)),
      tuning_(tuning),
      x_(start.size() > 0 ? start : Eigen::VectorXd::Zero(tuning.deviation.size())),
      P_(tuning.deviation.cwiseAbs2().asDiagonal()) {}

Eigen::VectorXd LinearRival::row(const Functions& functions, const Sample& sample) {
  Eigen::VectorXd sum = functions(sample.speeds[0]);
  for (size_t part = 1; part < kParts; ++part) sum += functions(sample.speeds[part]);
  return sum / static_cast<double>(kParts);
}

double LinearRival::step(const LinearTuning& tuning, const Eigen::VectorXd& h, double residual,
                         double noise, Eigen::VectorXd& x, Eigen::MatrixXd& P) {
  P /= tuning.forgetting;
  if (tuning.walk > 0.0) P.diagonal() += tuning.walk * tuning.deviation.cwiseAbs2();
  const Eigen::VectorXd Ph = P * h;
  const double expected = h.dot(Ph) + tuning.noise * noise;
  const double y = residual - h.dot(x);
  const double S = h.dot(Ph) + inflation(y, expected) * tuning.noise * noise;
  x += y / S * Ph;
  P -= Ph * Ph.transpose() / S;
  return logDensity(y, expected);
}

void LinearRival::learn(const Sample& sample) {
  step(tuning_, row(functions_, sample), sample.residual[axis_], sample.noise[axis_], x_, P_);
}

double LinearRival::offset(const Eigen::Vector2d& speed) const {
  return functions_(speed).dot(x_);
}

double GaussianProcess::extend(const Sample& sample) {
  const auto n = static_cast<Eigen::Index>(samples_.size());
  Eigen::VectorXd row(n);
  for (Eigen::Index i = 0; i < n; ++i)
    row[i] = kernel(tuning_, samples_[static_cast<size_t>(i)], sample);
  L_.triangularView<Eigen::Lower>().solveInPlace(row);
  const double own = kernel(tuning_, sample, sample) - row.squaredNorm();
  const double noise = tuning_.noise * sample.noise[axis_];
  const double y = sample.residual[axis_] - row.dot(z_);
  const double S = own + noise * inflation(y, own + noise);
  L_.conservativeResize(n + 1, n + 1);
  L_.row(n).head(n) = row;
  L_(n, n) = std::sqrt(S);
  z_.conservativeResize(n + 1);
  z_[n] = y / L_(n, n);
  samples_.push_back(sample);
  return logDensity(y, own + noise);
}

void GaussianProcess::learn(const Sample& sample) {
  extend(sample);
  weights_ = L_.triangularView<Eigen::Lower>().transpose().solve(z_);
}

double GaussianProcess::offset(const Eigen::Vector2d& speed) const {
  double sum = 0.0;
  for (size_t i = 0; i < samples_.size(); ++i)
    sum += weights_[static_cast<Eigen::Index>(i)] * kernel(tuning_, samples_[i], speed);
  return sum;
}

double GaussianProcess::logLikelihood(size_t axis, const KernelTuning& tuning,
                                      const Sample* samples, size_t count) {
  GaussianProcess process(axis, tuning);
  double sum = 0.0;
  for (size_t i = 0; i < count; ++i) sum += process.extend(samples[i]);
  return sum;
}

AxisRivals::AxisRivals(const AxisRivals& other) {
  for (size_t axis = 0; axis < kAxes; ++axis)
    if (other.axes_[axis]) axes_[axis] = other.axes_[axis]->clone();
}

void AxisRivals::learn(const Sample& sample) {
  for (const auto& axis : axes_)
    if (axis) axis->learn(sample);
}

std::vector<Twist2> AxisRivals::corrected(std::vector<Twist2> twists, const Sample& sample) const {
  for (size_t part = 0; part < kParts; ++part) {
    const auto offset = [&](size_t axis) {
      return axes_[axis] ? axes_[axis]->offset(sample.speeds[part]) : 0.0;
    };
    const Twist2 change{offset(0), offset(1), offset(2)};
    for (size_t t = 0; t < twists.size(); ++t) {
      if (t * kParts / twists.size() != part) continue;
      twists[t].v_x += change.v_x;
      twists[t].v_y += change.v_y;
      twists[t].omega += change.omega;
    }
  }
  return twists;
}

}  // namespace tread::adaptation
