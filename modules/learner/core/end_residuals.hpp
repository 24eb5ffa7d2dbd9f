// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "common/pattern/pattern.hpp"

namespace tread::learner {

/// How quickly the covariance of predictions follows what is observed.
struct ResidualLimits {
  int64_t min_count = 3;      ///< residuals before a covariance is called known
  int64_t shipped_count = 5;  ///< residuals that a shipped covariance counts for
  double min_weight = 0.10;   ///< [1] of the newest residual, however many there were
};

/// Running mean of squared prediction errors of one pattern's end pose: about zero, because a bias
/// misleads the planner as much as noise does.
struct EndResiduals {
  int64_t count = 0;
  PoseCovariance mean{};  ///< [m2, m rad, rad2]; meaningless while count is 0
};

/// The beginning for a pattern, from its shipped covariance if that is known.
EndResiduals residualsOf(const MotionPattern& shipped, const ResidualLimits& limits);

/// Takes one error of the end pose, measured relative to predicted, in the pattern's start frame,
/// yaw wrapped.
void addResidual(EndResiduals& residuals, const Pose2& error, const ResidualLimits& limits);

/// What may be told to the planner: NaN until enough was seen.
PoseCovariance covarianceOf(const EndResiduals& residuals, const ResidualLimits& limits);

/// Whether a covariance says anything: all numbers finite, not all variances zero.
bool isKnown(const PoseCovariance& covariance);

}  // namespace tread::learner
