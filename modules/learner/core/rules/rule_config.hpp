// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <cstdint>
#include <string>

#include "modules/learner/core/end_residuals.hpp"
#include "modules/learner/core/scaling.hpp"

namespace tread::learner {

/// Noise of one execution on unchanged ground: standard deviations of its mean body twist.
struct TwistNoise {
  double forward = 0.03;      ///< [1] of |v_x|
  double lateral = 0.03;      ///< [1] of v_y over |v_x|
  double yaw = 0.08;          ///< [1] of |omega|
  double floor_speed = 0.01;  ///< [m/s] added to the first two
  double floor_yaw = 0.01;    ///< [rad/s] added to the third
};

/// Parameters of the local filter; the header of the rule has the equations.
struct FilterConfig {
  TwistNoise noise;           ///< expected where nothing was recorded
  double recorded = 0.3;      ///< [1] share of the recorded spread of ends in the noise
  double noise_factor = 1.2;  ///< [1] on the noise's standard deviations
  double caution = 2.1;       ///< [1] the same once more on unknown ground: tails are heavy
  double hazard = 0.05;       ///< [1] probability of a change of ground before an execution
  /// Standard deviations of one change: forward gain [1], yaw gain [1], sideslip [s], turn loss
  /// [s], yaw by speed [s/m], yaw bias [rad/m], crab [1].
  std::array<double, 7> common{0.10, 0.20, 0.15, 0.15, 0.08, 0.02, 0.02};
  /// Of a pattern's own residual: of v_x, of v_y over v_x, of omega [1].
  std::array<double, 3> residual{0.08, 0.06, 0.12};
  double common_factor = 0.7;  ///< [1] on `common`
  double steady = 1.7;  ///< [1] covariance at the start, and in the long run unobserved, over Q
  double drift = 0.01;  ///< [1] share by which P tends there before each execution
};

/// Parameters of the bank of remembered surfaces.
struct BankConfig {
  double hazard = 0.32;         ///< [1] probability that the surface changes before an execution
  double unknown_prior = 0.5;   ///< [1] that the next one is not in the bank
  int64_t settled_after = 10;   ///< executions without a change that make a block
  double new_margin = 3.0;      ///< [1] of log density, by which a block must be likelier as new
  double settled_change = 0.5;  ///< [1] probability of a change that counts as one
  double unknown_share = 1.0;   ///< [1] of Q: how far an unknown surface is from the known one
  int64_t capacity = 16;        ///< surfaces; the one that was met longest ago makes room
};

/// Name of a rule of learning: one of ruleNames().
using Rule = std::string;

/// The rule of learning and its guards.
struct RuleConfig {
  Rule rule = "bank";
  double memory = 0.5;  ///< w of equation (2): weight of the OLD prediction, 0 <= w < 1
  ScalingLimits scaling;
  ResidualLimits residuals;
  double sign_sigmas = 3.0;  ///< how far beyond the noise M and R must disagree in sign
  /// [1] of a prediction's end where no covariance is known
  Axes relative_noise{0.03, 0.03, 0.08};
  Axes absolute_noise{0.02, 0.02, 0.02};  ///< [m, m, rad] added to it
  FilterConfig filter;
  BankConfig bank;
};

}  // namespace tread::learner
