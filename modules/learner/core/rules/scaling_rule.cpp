// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/core/rules/scaling_rule.hpp"

#include <cmath>

namespace tread::learner {
namespace {

/// A box beyond any vehicle's reach [m, m, rad] must not become a prediction.
constexpr double kLargestBox = 1e6;
/// Standard deviation of a prediction's end without a covariance: [1] of x, y and yaw, plus [m, m,
/// rad].
constexpr double kRelativeNoise[3] = {0.03, 0.03, 0.08};
constexpr double kAbsoluteNoise[3] = {0.02, 0.02, 0.02};

}  // namespace

ScalingRule::ScalingRule(const RuleConfig& config, const PatternSet& shipped)
    : StoredPredictions(config, shipped),
      limits_(config.scaling),
      sign_sigmas_(config.sign_sigmas) {
  for (const MotionPattern& pattern : shipped.patterns()) {
    roles_.push_back(roleOf(pattern, config.scaling));
    const PoseCovariance& covariance = pattern.end_covariance;
    variances_.emplace_back(covariance[0], covariance[3], covariance[5]);
  }
}

void ScalingRule::learn(size_t executed, const ConstTrajectory& measured, RuleNote& note) {
  Boxes boxes;
  boxes.measured = boundingBox(measured);
  if (!(boxes.measured < kLargestBox).all()) return;
  const bool gives = allow(executed, measured, table_.end(executed), note);
  boxes.before = boundingBox(table_.of(executed));
  smooth(measured, memory_, table_.change(executed));  // equation (2)
  if (!gives) return;
  boxes.after = boundingBox(table_.of(executed));
  const Axes scaling = factors(boxes, roles_[executed], note);
  for (size_t p = 0; p < table_.patterns(); ++p)
    if (p != executed) scale(scaling, roles_[p], table_.change(p));
}

bool ScalingRule::allow(size_t executed, const ConstTrajectory& measured,
                        const Pose2& predicted_end, RuleNote& note) const {
  const PatternRole& role = roles_[executed];
  const Eigen::Index last = measured.rows() - 1;
  note.one_dimensional = !role.gives_scaling;
  if (note.one_dimensional) return false;
  note.moved_back = opposite(executed, 0, measured(last, 0), predicted_end.x);
  note.turned_back = opposite(executed, 2, measured(last, 2), predicted_end.yaw);
  if (note.moved_back || note.turned_back) return false;
  for (size_t axis = 0; axis < 3; ++axis) note.held[axis] = !role.scalable[axis];
  return true;
}

bool ScalingRule::opposite(size_t executed, int axis, double measured, double predicted) const {
  if (!roles_[executed].scalable[static_cast<size_t>(axis)] || measured * predicted >= 0.0)
    return false;
  const double variance = variances_[executed][axis];
  const double assumed = kRelativeNoise[axis] * std::abs(predicted) + kAbsoluteNoise[axis];
  const double sigma = variance > 0.0 ? std::sqrt(variance) : assumed;
  return std::abs(measured - predicted) > sign_sigmas_ * sigma;
}

}  // namespace tread::learner
