// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/core/rules/surface.hpp"

#include <algorithm>

namespace tread::learner {
namespace {

constexpr double kLargestTwist = 100.0;
/// No ground's corrections are beyond this, of whatever unit.
constexpr double kLargestCorrection = 1e9;
constexpr double kLargestVariance = 1e3;

/// P h.
void timesResponse(const PatternPart& part, size_t velocity, const Eigen::MatrixXd& P,
                   Eigen::VectorXd& Ph) {
  Ph.noalias() = part.own[velocity] * P.col(kTerms + static_cast<Eigen::Index>(part.pattern));
  for (Eigen::Index i = 0; i < kTerms; ++i)
    Ph.noalias() += part.common[velocity][static_cast<size_t>(i)] * P.col(i);
}

/// h' P h.
double variance(const PatternPart& part, size_t velocity, const Eigen::MatrixXd& P) {
  const Eigen::Index own = kTerms + static_cast<Eigen::Index>(part.pattern);
  const auto& common = part.common[velocity];
  double sum = part.own[velocity] * part.own[velocity] * P(own, own);
  for (Eigen::Index i = 0; i < kTerms; ++i) {
    const double h = common[static_cast<size_t>(i)];
    sum += 2.0 * h * part.own[velocity] * P(i, own);
    for (Eigen::Index j = 0; j < kTerms; ++j) sum += h * common[static_cast<size_t>(j)] * P(i, j);
  }
  return sum;
}

/// Logarithm of Student's density of y: centre 0, scale^2, degrees of freedom.
double logStudent(double y, double scale2, double freedom) {
  const double half = 0.5 * (freedom + 1.0);
  return std::lgamma(half) - std::lgamma(0.5 * freedom) - 0.5 * std::log(freedom * kPi * scale2) -
         half * std::log1p(y * y / (freedom * scale2));
}

}  // namespace

Eigen::Vector3d plausible(const Eigen::Vector3d& twist) {
  return twist.cwiseMax(-kLargestTwist).cwiseMin(kLargestTwist);
}

Surface::Surface(const GroundModel& model, const GroundConfig& config, const SurfacePrior& prior)
    : prior_(prior) {
  follow(model, config);
}

Surface::Measured& Surface::measuredOf(const PatternPart& part) {
  for (Measured& measured : measured_)
    if (measured.part.pattern == part.pattern && measured.part.samples == part.samples)
      return measured;
  measured_.push_back({part});
  return measured_.back();
}

void Surface::add(const GroundModel& model, const GroundConfig& config, const TwistSample& sample) {
  Measured& measured = measuredOf(sample.part);
  const Eigen::Vector3d deviation = sample.mean_twist - sample.part.mean;
  expected_noise_ = noise_;
  measured.count += 1.0;
  measured.sum += deviation;
  measured.squares += deviation.cwiseAbs2();
  executions_ += 1.0;
  if (executions_ > config.longest_memory) {
    const double kept = config.longest_memory / executions_;
    for (Measured& each : measured_) {
      each.count *= kept;
      each.sum *= kept;
      each.squares *= kept;
    }
    executions_ = config.longest_memory;
  }
  follow(model, config);
}

void Surface::expect(const GroundModel& model, const GroundConfig& config,
                     const Eigen::Matrix3Xd& scatter) {
  prior_.scatter = scatter;
  follow(model, config);
}

void Surface::follow(const GroundModel& model, const GroundConfig& config) {
  regress(model);
  estimateNoise(config);
}

Eigen::MatrixXd Surface::priorCovariance(const GroundModel& model, size_t velocity) const {
  Eigen::MatrixXd Q = prior_.residual * model.spread(velocity);
  Q.topLeftCorner<kTerms, kTerms>() =
      prior_.common.col(static_cast<Eigen::Index>(velocity)).asDiagonal();
  return Q;
}

void Surface::regress(const GroundModel& model) {
  Eigen::VectorXd Ph;
  for (size_t velocity = 0; velocity < kVelocities; ++velocity) {
    const auto axis = static_cast<Eigen::Index>(velocity);
    Eigen::VectorXd& x = x_[velocity];
    Eigen::MatrixXd& P = P_[velocity];
    x = prior_.centre[velocity];
    P = priorCovariance(model, velocity);
    // All executions of a part at once, part by part: cheaper than an inverse, and P stays
    // symmetric to the bit.
    for (const Measured& measured : measured_) {
      const double n = measured.count;
      timesResponse(measured.part, velocity, P, Ph);
      const double S = response(measured.part, velocity, Ph) +
                       expected_noise_[axis] * R(measured.part, axis) / n;
      const double y = measured.sum[axis] / n - response(measured.part, velocity, x);
      x += y / S * Ph;
      for (Eigen::Index j = 0; j < P.cols(); ++j) P.col(j) -= Ph[j] * Ph / S;
    }
  }
}

void Surface::estimateNoise(const GroundConfig& config) {
  for (size_t velocity = 0; velocity < kVelocities; ++velocity) {
    const auto axis = static_cast<Eigen::Index>(velocity);
    double a = 0.5 * config.noise_prior;
    double b = a;
    for (const Measured& measured : measured_) {
      const double moved = response(measured.part, velocity, x_[velocity]);
      const double expected =
          measured.squares[axis] - 2.0 * moved * measured.sum[axis] +
          measured.count * (moved * moved + variance(measured.part, velocity, P_[velocity]));
      a += 0.5 * measured.count;
      b += 0.5 * std::max(0.0, expected) / R(measured.part, axis);
    }
    noise_[axis] = std::clamp(b / a, kLeastNoise, kMostNoise);
    certainty_[axis] = std::min(a, 0.5 * config.most_freedom);
  }
}

Eigen::Vector3d Surface::squaredError(const TwistSample& sample) const {
  Eigen::Vector3d error;
  for (size_t velocity = 0; velocity < kVelocities; ++velocity) {
    const auto axis = static_cast<Eigen::Index>(velocity);
    const double y = sample.mean_twist[axis] - sample.part.mean[axis] -
                     response(sample.part, velocity, x_[velocity]);
    error[axis] = (y * y + variance(sample.part, velocity, P_[velocity])) / sample.part.noise[axis];
  }
  return error;
}

double Surface::logDensity(const TwistSample& sample) const {
  double log_density = 0.0;
  for (size_t velocity = 0; velocity < kVelocities; ++velocity) {
    const auto axis = static_cast<Eigen::Index>(velocity);
    const double y = sample.mean_twist[axis] - sample.part.mean[axis] -
                     response(sample.part, velocity, x_[velocity]);
    const double scale2 =
        variance(sample.part, velocity, P_[velocity]) + noise_[axis] * R(sample.part, axis);
    log_density += logStudent(y, scale2, 2.0 * certainty_[axis]);
  }
  return log_density;
}

Eigen::Vector3d Surface::added(const PatternPart& part) const {
  return {response(part, 0, x_[0]), response(part, 1, x_[1]), response(part, 2, x_[2])};
}

Eigen::Vector3d Surface::doubt(const PatternPart& part) const {
  return {variance(part, 0, P_[0]), variance(part, 1, P_[1]), variance(part, 2, P_[2])};
}

Eigen::Vector3d Surface::executionNoise(const PatternPart& part) const {
  // The variance of Student's t over its scale^2: freedom / (freedom - 2).
  const Eigen::Array3d a = certainty_.array();
  return noise_.array() * part.noise.array() *
         prior_.scatter.col(static_cast<Eigen::Index>(part.pattern)).array() * a / (a - 1.0);
}

void Surface::save(std::vector<double>& memory) const {
  memory.push_back(prior_.residual);
  memory.insert(memory.end(), prior_.common.data(), prior_.common.data() + prior_.common.size());
  for (const Eigen::VectorXd& centre : prior_.centre)
    memory.insert(memory.end(), centre.data(), centre.data() + centre.size());
  memory.insert(memory.end(), prior_.scatter.data(), prior_.scatter.data() + prior_.scatter.size());
  memory.insert(memory.end(), expected_noise_.data(), expected_noise_.data() + 3);
  memory.push_back(executions_);
  memory.push_back(static_cast<double>(measured_.size()));
  for (const Measured& measured : measured_) {
    memory.insert(memory.end(), {static_cast<double>(measured.part.pattern),
                                 static_cast<double>(measured.part.samples), measured.count});
    memory.insert(memory.end(), measured.sum.data(), measured.sum.data() + 3);
    memory.insert(memory.end(), measured.squares.data(), measured.squares.data() + 3);
  }
}

bool Surface::restoreMeasured(const GroundModel& model, const std::vector<double>& memory,
                              size_t& at) {
  constexpr size_t kEach = 9;
  const double parts = memory[at++];
  if (!isCount(parts, static_cast<double>((memory.size() - at) / kEach))) return false;
  measured_.clear();
  double executions = 0.0;
  for (size_t i = 0; i < static_cast<size_t>(parts); ++i, at += kEach) {
    if (!isCount(memory[at], static_cast<double>(model.patterns()) - 1.0)) return false;
    const auto pattern = static_cast<size_t>(memory[at]);
    const double samples = memory[at + 1];
    if (samples < 1.0 || !isCount(samples, static_cast<double>(model.profile(pattern).samples())))
      return false;
    Measured measured{model.part(pattern, static_cast<Eigen::Index>(samples))};
    measured.count = memory[at + 2];
    measured.sum = Eigen::Map<const Eigen::Vector3d>(&memory[at + 3]);
    measured.squares = Eigen::Map<const Eigen::Vector3d>(&memory[at + 6]);
    if (!(measured.count > 0.0 && measured.count <= kMostExecutions) ||
        measured.squares.minCoeff() < 0.0 ||
        measured.sum.cwiseAbs().maxCoeff() > kLargestTwist * 2.0 * measured.count)
      return false;
    executions += measured.count;
    measured_.push_back(measured);
  }
  return std::abs(executions - executions_) <= 1e-6 * (1.0 + executions_);
}

bool Surface::restore(const GroundModel& model, const GroundConfig& config,
                      const std::vector<double>& memory, size_t& at) {
  size_t numbers = 15 + static_cast<size_t>(prior_.scatter.size());
  for (const Eigen::VectorXd& centre : prior_.centre) numbers += static_cast<size_t>(centre.size());
  if (memory.size() < at + numbers) return false;
  prior_.residual = memory[at++];
  for (double& variance : prior_.common.reshaped()) variance = memory[at++];
  double largest = 0.0;
  for (Eigen::VectorXd& centre : prior_.centre)
    for (double& number : centre) {
      number = memory[at++];
      largest = std::max(largest, std::abs(number));
    }
  for (double& scatter : prior_.scatter.reshaped()) scatter = memory[at++];
  for (double& noise : expected_noise_) noise = memory[at++];
  executions_ = memory[at++];
  if (!(prior_.residual > 0.0 && prior_.residual <= 1.0) || prior_.common.minCoeff() <= 0.0 ||
      prior_.common.maxCoeff() > kLargestVariance || largest > kLargestCorrection ||
      prior_.scatter.minCoeff() < kLeastNoise || prior_.scatter.maxCoeff() > kMostNoise ||
      expected_noise_.minCoeff() < kLeastNoise || expected_noise_.maxCoeff() > kMostNoise ||
      !(executions_ >= 0.0 && executions_ <= kMostExecutions) ||
      !restoreMeasured(model, memory, at))
    return false;
  follow(model, config);
  return true;
}

}  // namespace tread::learner
