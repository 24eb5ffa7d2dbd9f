// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/core/end_residuals.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace tread::learner {

bool isKnown(const PoseCovariance& covariance) {
  const bool finite = std::all_of(covariance.begin(), covariance.end(),
                                  [](double element) { return std::isfinite(element); });
  // Nothing is certain: all variances zero come from a model that tells of no spread.
  return finite && (covariance[0] > 0.0 || covariance[3] > 0.0 || covariance[5] > 0.0);
}

EndResiduals residualsOf(const MotionPattern& shipped, const ResidualLimits& limits) {
  if (!isKnown(shipped.end_covariance)) return {};
  return {limits.shipped_count, shipped.end_covariance};
}

void addResidual(EndResiduals& residuals, const Pose2& error, const ResidualLimits& limits) {
  const PoseCovariance square{error.x * error.x, error.x * error.y,   error.x * error.yaw,
                              error.y * error.y, error.y * error.yaw, error.yaw * error.yaw};
  ++residuals.count;
  const double weight = std::max(1.0 / static_cast<double>(residuals.count), limits.min_weight);
  for (size_t i = 0; i < square.size(); ++i)
    residuals.mean[i] += weight * (square[i] - residuals.mean[i]);
}

PoseCovariance covarianceOf(const EndResiduals& residuals, const ResidualLimits& limits) {
  if (residuals.count >= limits.min_count) return residuals.mean;
  PoseCovariance unknown;
  unknown.fill(std::numeric_limits<double>::quiet_NaN());
  return unknown;
}

}  // namespace tread::learner
