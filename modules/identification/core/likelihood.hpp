// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "modules/identification/core/observations.hpp"

namespace tread::gap {

/// Normal quantile of 97.5 %.
inline constexpr double kNormal975 = 1.959964;

/// Quantile of Student's distribution with the probability of a normal quantile.
/** Cornish and Fisher's expansion: within .5 % from 3 degrees of freedom on for 97.5 %, too large
 * by a tenth at 8 degrees for 1e-4. */
double studentQuantile(double freedom, double normal_quantile = kNormal975);

/// Normal quantile that is exceeded in magnitude with a probability of `chance` (0 to 1).
double normalQuantileOf(double chance);

/// Probability that a normal number exceeds a quantile in magnitude.
double chanceBeyond(double normal_quantile);

/// Negative log likelihood of a residual with a scale, without constants [nats].
double lossOf(double residual, double scale);
/// Its negative derivative with respect to the prediction: positive for a positive residual.
double pullOf(double residual, double scale);
/// Weight of a row in an iterated least squares fit: pull over residual.
double weightOf(double residual, double scale);

/// Size of the residuals of one channel: scale^2 = still^2 + (share activity)^2.
/** The ground disturbs a motion in proportion to it, the INS independently. */
struct ChannelNoise {
  double still = 1.0;  ///< [rad/s or m/s]
  double share = 0.0;  ///< [1]
};
using Noise = std::array<ChannelNoise, kChannels>;

/// Size of the motion at each observation: |yaw rate| for the yaw channels, speed for the others.
Eigen::VectorXd activityOf(const std::vector<Observation>& data, const Eigen::VectorXd& predicted);

/// Maximum likelihood noise of residuals; rows whose mask is 0 do not count.
Noise estimateNoise(const std::vector<Observation>& data, const Eigen::VectorXd& residuals,
                    const Eigen::VectorXd& activity, const std::vector<char>& mask);

/// Scale of every row.
Eigen::VectorXd scalesOf(const std::vector<Observation>& data, const Noise& noise,
                         const Eigen::VectorXd& activity);

/// Sum of the losses of rows whose mask is not 0.
double totalLoss(const Eigen::VectorXd& residuals, const Eigen::VectorXd& scales,
                 const std::vector<char>& mask);

}  // namespace tread::gap
