// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "modules/learner/core/rules/ground_filter.hpp"
#include "modules/learner/core/rules/learning_rule.hpp"

namespace tread::learner {

/// A hierarchical Kalman filter in body-twist space (own work).
/** What the ground does to the executed pattern's mean body twist is split into corrections that
 * all patterns share (gains, sideslip, turn loss, ...: twist_profile.hpp) and the pattern's own
 * residual, in proportion to their covariances (ground_model.hpp), by a filter that expects jumps
 * (ground_filter.hpp). Predictions are the shipped twist profiles under the filter's mean,
 * integrated again; so a strong turn is corrected along its arc, which scaling x and y cannot do.
 * Covariance of an end pose [m2, m rad, rad2]: J P J' + that of one execution, J the response of
 * the end pose. It knows no driven trajectory by heart: shapes stay the shipped ones. */
class LocalFilter : public LearningRule {
 public:
  LocalFilter(const RuleConfig& config, const PatternSet& shipped);

  void learn(size_t executed, const ConstTrajectory& measured, RuleNote& note) override;
  std::string reason(const RuleNote& note) const override;
  void predict(size_t pattern, Trajectory prediction) const override;
  Pose2 predictEnd(size_t pattern) const override;
  std::optional<PoseCovariance> endCovariance(size_t pattern) const override;
  void assign(const LearningRule& other) override;
  std::unique_ptr<LearningRule> clone() const override {
    return std::make_unique<LocalFilter>(*this);
  }
  std::vector<double> memory() const override;
  bool restore(const TrajectoryTable& predictions, const std::vector<double>& memory) override;

 private:
  std::shared_ptr<const GroundModel> model_;
  GroundFilter filter_;
};

/// A probability in words: "97 %".
std::string percent(double probability);

/// The upper triangle of a symmetric matrix.
PoseCovariance upperTriangle(const Eigen::Matrix3d& covariance);

}  // namespace tread::learner
