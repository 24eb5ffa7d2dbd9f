// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "modules/learner/core/rules/stored_predictions.hpp"

namespace tread::learner {

/// Whether an execution of a pattern may tell the others how to scale.
class ScalingGuards {
 public:
  ScalingGuards(const RuleConfig& config, const PatternSet& shipped);

  /// Whether a box is one that a vehicle can drive; what is not must not become a prediction.
  static bool possible(const Axes& box) { return (box < kLargestBox).all(); }
  /// Fills the guards of `note`; true if a V may be computed from this measurement.
  bool allow(size_t executed, const ConstTrajectory& measured, const Pose2& predicted_end,
             RuleNote& note) const;
  const PatternRole& role(size_t pattern) const { return roles_[pattern]; }

 private:
  static constexpr double kLargestBox = 1e6;  ///< [m, m, rad]

  bool opposite(size_t executed, int axis, double measured, double predicted) const;

  std::vector<PatternRole> roles_;
  std::vector<Axes> variances_;  ///< of the shipped ends; NaN = unknown
  Axes relative_noise_;
  Axes absolute_noise_;
  double sign_sigmas_;
};

/// Collective Motion Pattern Scaling, the paper's algorithm (section IV, Algorithm 1; Table I
/// column c).
/** From the measured trajectory M of the executed pattern MP* and its prediction R* before the
 * update, boxes with the start pose in them, x and y [m], yaw interval [rad]:
 *    V = (x_s, y_s, phi_s) = box(M) / box(R*)                                     equation (1)
 *    R* <- (1 - w) M + w R*                                                       equation (2)
 *    R_p <- (1 - w) V R_p + w R_p   for every other pattern p                     equation (2)
 * with w the weight of the old prediction (equation (2); line 13 of Algorithm 1 swaps the roles).
 * Guards, see scaling.hpp: an axis whose shipped box is noise keeps the factor 1 for good; a
 * pattern of one dimension gives no V; nor does a measurement that went the other way; V is kept
 * within limits. Known faults: on unchanged ground the patterns that are never driven drift,
 * because the mean of a quotient of noisy boxes is not 1 (telescoping.hpp has none of it); and as
 * every pattern gets the same factor, the ratios between patterns stay those of the shipped set for
 * ever, also where all are measured exactly (telescoping has that, too). */
class Collective : public StoredPredictions {
 public:
  Collective(const RuleConfig& config, const PatternSet& shipped)
      : StoredPredictions(shipped),
        guards_(config, shipped),
        limits_(config.scaling),
        memory_(config.memory) {}

  void learn(size_t executed, const ConstTrajectory& measured, RuleNote& note) override;
  std::unique_ptr<LearningRule> clone() const override {
    return std::make_unique<Collective>(*this);
  }

 private:
  ScalingGuards guards_;
  ScalingLimits limits_;
  double memory_;
};

}  // namespace tread::learner
