// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include "modules/identification/core/observations.hpp"

namespace tread::gap {

/// Normal quantile of 97.5 %.
inline constexpr double kNormal975 = 1.959964;

/// Quantile of Student's distribution that has the probability of a normal quantile.
/** Cornish and Fisher's expansion: within .5 % from 3 degrees of freedom on for 97.5 %, too large
 * by a tenth at 8 degrees for 1e-4. */
double studentQuantile(double freedom, double normal_quantile = kNormal975);

/// Normal quantile that is exceeded, either way, with a probability of `chance` (0 to 1).
double normalQuantileOf(double chance);

/// Chance that a normal number exceeds a quantile, either way.
double chanceBeyond(double normal_quantile);

/// Negative log likelihood of a residual over its scale, without constants [nats].
double lossOf(double residual, double scale);
/// Its derivative by the prediction, negated: positive for a positive residual.
double pullOf(double residual, double scale);
/// Weight with which an iterated least squares fit takes a row: pull over residual.
double weightOf(double residual, double scale);

/// How large residuals of one channel are: scale^2 = still^2 + (share activity)^2.
/** The ground disturbs a motion in proportion to it, the INS by itself. */
struct ChannelNoise {
  double still = 1.0;  ///< [rad/s or m/s]
  double share = 0.0;  ///< [1]
};
using Noise = std::array<ChannelNoise, kChannels>;

/// Size of the motion at each observation: |yaw rate| for the yaw channels, speed for the others.
Eigen::VectorXd activityOf(const std::vector<Observation>& data, const Eigen::VectorXd& predicted);

/// Noise of greatest likelihood for residuals; rows whose mask is 0 do not count.
Noise estimateNoise(const std::vector<Observation>& data, const Eigen::VectorXd& residuals,
                    const Eigen::VectorXd& activity, const std::vector<char>& mask);

/// Scale of every row.
Eigen::VectorXd scalesOf(const std::vector<Observation>& data, const Noise& noise,
                         const Eigen::VectorXd& activity);

/// Sum of the losses of rows whose mask is not 0.
double totalLoss(const Eigen::VectorXd& residuals, const Eigen::VectorXd& scales,
                 const std::vector<char>& mask);

}  // namespace tread::gap
