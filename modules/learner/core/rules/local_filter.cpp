// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/core/rules/local_filter.hpp"

#include <cmath>

namespace tread::learner {

std::string percent(double probability) {
  return std::to_string(std::lround(100.0 * probability)) + " %";
}

PoseCovariance upperTriangle(const Eigen::Matrix3d& covariance) {
  return {covariance(0, 0), covariance(0, 1), covariance(0, 2),
          covariance(1, 1), covariance(1, 2), covariance(2, 2)};
}

LocalFilter::LocalFilter(const RuleConfig& config, const PatternSet& shipped)
    : model_(std::make_shared<GroundModel>(config.filter, shipped)),
      filter_(model_, config.filter) {}

void LocalFilter::learn(size_t executed, const ConstTrajectory& measured, RuleNote& note) {
  const Eigen::Vector3d mean_twist = meanTwist(measured, model_->period());
  if (!mean_twist.allFinite()) return;  // beyond all numbers
  filter_.update(executed, mean_twist);
  note.change_probability = filter_.changeProbability();
}

std::string LocalFilter::reason(const RuleNote& note) const {
  return note.change_probability > 0.5
             ? "the ground changed (" + percent(note.change_probability) + ")"
             : "the same ground (" + percent(1.0 - note.change_probability) + ")";
}

void LocalFilter::predict(size_t pattern, Trajectory prediction) const {
  model_->profile(pattern).integrate(model_->correctionOf(filter_.mean(), pattern), prediction);
}

Pose2 LocalFilter::predictEnd(size_t pattern) const {
  return model_->profile(pattern).integrateEnd(model_->correctionOf(filter_.mean(), pattern));
}

std::optional<PoseCovariance> LocalFilter::endCovariance(size_t pattern) const {
  const auto& J = model_->profile(pattern).endResponse();
  return upperTriangle(J * model_->covarianceOf(filter_.covariance(), pattern) * J.transpose() +
                       model_->endNoise(pattern));
}

void LocalFilter::assign(const LearningRule& other) {
  filter_.assign(static_cast<const LocalFilter&>(other).filter_);
}

std::vector<double> LocalFilter::memory() const {
  std::vector<double> memory;
  filter_.save(memory);
  return memory;
}

bool LocalFilter::restore(const TrajectoryTable&, const std::vector<double>& memory) {
  GroundFilter restored = filter_;
  size_t at = 0;
  if (!restored.restore(memory, at) || at != memory.size()) return false;
  filter_ = restored;
  return true;
}

}  // namespace tread::learner
