// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <cmath>

#include <Eigen/LU>

#include "modules/learner/core/rules/multi_model.hpp"

// The rule's uncertainty of a prediction: regions, and factors that keep their coverage.
namespace tread::learner {
namespace {

/// Smaller weights are ignored in a region [1].
constexpr double kLeastWeight = 1e-4;
/// Scales of a ground with smaller weights are ignored in its region [1].
constexpr double kLeastInRegion = 0.003;
/// Largest probability of a coming change that a region includes [1]: an event rarer than one in
/// ten is outside of 90 % anyway.
constexpr double kRegionHazard = 0.03;
/// Chi-square of three degrees of freedom, 90 %.
constexpr double kQuantile = 6.251;
constexpr double kLevel = 0.9;
/// Step of the factors, in logarithms of a deviation.
constexpr double kCalibrationStep = 0.03;
/// Probability of recent ground from which the rule is searching [1].
constexpr double kSearching = 0.3;

/// Distribution of a component's d2 about the mixture's mean, in the region's shape: a gamma
/// distribution of its mean and variance (Wilson-Hilferty), for computing a 90 % quantile.
class Distance {
 public:
  Distance(double weight, double mean, double variance) : weight_(weight) {
    const double k = mean * mean / variance;
    const double steep = 3.0 * std::sqrt(0.5 * k);
    slope_ = steep / std::cbrt(mean);
    offset_ = steep * (1.0 - 1.0 / (9.0 * k));
  }
  /// This component's share of the mixture below the cube of `root`.
  double below(double root) const { return weight_ * 0.5 * std::erfc(offset_ - slope_ * root); }

 private:
  double weight_;
  double slope_, offset_;  ///< the cube root of d2, standardized: sqrt(2) (slope cbrt(d2) - offset)
};

double quantileOf(const std::vector<Distance>& distances) {
  double low = std::log(1e-4), high = std::log(1e3);
  for (int i = 0; i < 24; ++i) {  // to a millionth
    const double middle = 0.5 * (low + high);
    const double root = std::exp(middle / 3.0);
    double below = 0.0;
    for (const Distance& distance : distances) below += distance.below(root);
    (below < kLevel ? low : high) = middle;
  }
  return std::exp(low);
}

/// One hypothesis of ground, relative to the mixture's mean.
struct Component {
  double weight;
  Moments moments;
  Eigen::Matrix3d square() const {
    return moments.covariance + moments.mean * moments.mean.transpose();
  }
  Distance from(const Eigen::Matrix3d& inverse) const {
    const Eigen::Vector3d& d = moments.mean;
    const Eigen::Matrix3d share = inverse * moments.covariance;
    const Eigen::Vector3d scaled = inverse * d;
    return {weight, share.trace() + d.dot(scaled),
            2.0 * (share * share).trace() + 4.0 * scaled.dot(moments.covariance * scaled)};
  }
};

/// Covariance of the nearest components with a total weight of 90 %. Sorts them.
Eigen::Matrix3d shapeOf(std::vector<Component>& components) {
  Eigen::Matrix3d all = Eigen::Matrix3d::Zero();
  for (const Component& component : components) all += component.weight * component.square();
  const Eigen::Matrix3d inverse = all.inverse();
  const auto distance = [&](const Component& component) {
    return (inverse * component.square()).trace();
  };
  std::sort(components.begin(), components.end(),
            [&](const Component& a, const Component& b) { return distance(a) < distance(b); });
  double weight = 0.0;
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  for (const Component& component : components) {
    if (weight >= kLevel) break;
    const double share = std::min(component.weight, kLevel - weight);
    weight += share;
    sum += share * component.square();
  }
  return sum / weight;
}

PoseCovariance upperTriangle(const Eigen::Matrix3d& c) {
  return {c(0, 0), c(0, 1), c(0, 2), c(1, 1), c(1, 2), c(2, 2)};
}

}  // namespace

void Calibration::follow(bool held) {
  log_factor = std::clamp(log_factor + kCalibrationStep * ((held ? 0.0 : 1.0) - (1.0 - kLevel)),
                          kNarrowest, kWidest);
}

/// Whether it may be on ground that it has only begun to learn.
bool MultiModel::searching() const {
  double young = 0.0;
  for (const Hypothesis& hypothesis : fresh_)
    if (!settled(hypothesis.surface)) young += hypothesis.weight;
  return young > kSearching;
}

/// Mean of the mixture, and a covariance whose 90 % ellipsoid contains the next execution with 90
/// %.
/** Its shape is that of the components that make up the 90 %: rare and distant ones, like new
 * ground ahead, would stretch it in the direction in which new ground is least certain. */
Moments MultiModel::region(const PatternPart& part) const {
  const double h = std::min(hazard(part.metres), kRegionHazard);
  std::vector<Component> components;
  const auto put = [&](double weight, const Surface& surface) {
    if (weight < kLeastWeight) return;
    Moments moments = surface.expected(part, kLeastInRegion);
    moments.covariance.diagonal() += surface.executionNoise(part);
    components.push_back({weight, moments});
  };
  for (const Hypothesis& known : surfaces_)
    put((1.0 - h) * known.weight +
            h * (1.0 - config_.fresh) / static_cast<double>(surfaces_.size()),
        known.surface);
  for (const Hypothesis& fresh : fresh_) put((1.0 - h) * fresh.weight, fresh.surface);
  put(h * config_.fresh, new_);
  Moments all{expected(part).added(part), Eigen::Matrix3d::Zero()};
  double total = 0.0;
  for (Component& component : components) {
    total += component.weight;
    component.moments.mean -= all.mean;
  }
  for (Component& component : components) component.weight /= total;
  all.covariance = shapeOf(components);
  const Eigen::Matrix3d inverse = all.covariance.inverse();
  std::vector<Distance> distances;
  for (const Component& component : components) distances.push_back(component.from(inverse));
  const Calibration& calibration = searching() ? searching_ : calm_;
  all.covariance *= quantileOf(distances) / kQuantile * std::exp(2.0 * calibration.log_factor);
  return all;
}

std::optional<TwistDeparture> MultiModel::departure(size_t pattern, const ConstTrajectory& measured,
                                                    Eigen::Index first,
                                                    Eigen::Index samples) const {
  ContextEffects effects = effects_;
  effects.meet(context_.voltage);
  const auto of_samples = stretch(effects, pattern, measured, first, samples);
  if (!of_samples) return std::nullopt;
  const Surface& ground = likeliest().surface;
  const TwistSample usual = ground.asUsual(of_samples->sample);
  Moments expected = ground.expected(usual.part);
  expected.covariance.diagonal() += ground.usualNoise(usual.part);
  const Eigen::Matrix3d turn = usual.part.toBody();
  return TwistDeparture{turn * (usual.deviation() - expected.mean),
                        turn * expected.covariance * turn.transpose()};
}

void MultiModel::calibrate(const TwistSample& sample) {
  const Moments expected = region(sample.part);
  const Eigen::Vector3d d = sample.deviation() - expected.mean;
  const bool held = d.dot(expected.covariance.inverse() * d) <= kQuantile;
  (searching() ? searching_ : calm_).follow(held);
}

std::optional<PoseCovariance> MultiModel::endCovariance(size_t pattern) const {
  const PatternPart& part = model_->whole(pattern);
  const Eigen::Matrix3d lever = model_->profile(pattern).endLever() * part.toBody();
  Eigen::Matrix3d covariance = lever * region(part).covariance * lever.transpose();
  covariance.diagonal().head<2>().array() +=
      part.shape * expected_scatter_(3, static_cast<Eigen::Index>(pattern));
  return upperTriangle(0.5 * (covariance + covariance.transpose()));
}

}  // namespace tread::learner
