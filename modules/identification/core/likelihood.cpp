// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors

#include "modules/identification/core/likelihood.hpp"

#include <algorithm>
#include <cmath>

#include "common/statistics/statistics.hpp"

namespace tread::gap {
namespace {

constexpr double kLeastScale = 1e-6;  // [rad/s or m/s], for residuals that are all 0

/// Residuals of one channel with the motion in their rows.
struct ChannelResiduals {
  std::vector<double> residual;
  std::vector<double> activity;
};

double negativeLogLikelihood(const ChannelResiduals& of, const ChannelNoise& noise) {
  double sum = 0.0;
  for (size_t i = 0; i < of.residual.size(); ++i) {
    const double scale = std::hypot(noise.still, noise.share * of.activity[i]);
    sum += lossOf(of.residual[i], scale) + std::log(scale);
  }
  return sum;
}

double medianSize(std::vector<double> values) {
  if (values.empty()) return kLeastScale;
  for (double& value : values) value = std::abs(value);
  return std::max(kLeastScale, quantileOf(std::move(values), 0.5));
}

/// Least negative log likelihood by steps along either logarithm, halved if none helps.
ChannelNoise estimated(const ChannelResiduals& of) {
  const double size = medianSize(of.residual) / 0.74;  // median of |t| with 4 degrees of freedom
  const double busy = medianSize(of.activity);
  ChannelNoise best{size * 0.7, 0.7 * size / std::max(busy, 1e-3)};
  double least = negativeLogLikelihood(of, best);
  for (double step = std::log(2.0); step > 0.01;) {
    bool better = false;
    for (const auto& [still, share] : {std::pair{1.0, 0.0}, {-1.0, 0.0}, {0.0, 1.0}, {0.0, -1.0}}) {
      const ChannelNoise tried{std::max(kLeastScale, best.still * std::exp(still * step)),
                               best.share * std::exp(share * step)};
      const double loss = negativeLogLikelihood(of, tried);
      if (!(loss < least - 1e-9)) continue;  // also rejects NaN
      least = loss;
      best = tried;
      better = true;
    }
    if (!better) step /= 2.0;
  }
  return best;
}

}  // namespace

double studentQuantile(double freedom, double normal_quantile) {
  const double z = normal_quantile;
  const double n = std::max(3.0, freedom);
  const double z3 = z * z * z;
  const double z5 = z3 * z * z;
  const double z7 = z5 * z * z;
  return z + (z3 + z) / (4.0 * n) + (5.0 * z5 + 16.0 * z3 + 3.0 * z) / (96.0 * n * n) +
         (3.0 * z7 + 19.0 * z5 + 17.0 * z3 - 15.0 * z) / (384.0 * n * n * n);
}

double chanceBeyond(double normal_quantile) {
  return std::erfc(normal_quantile / std::sqrt(2.0));
}

double normalQuantileOf(double chance) {
  double low = 0.0;
  double high = 38.0;  // above it the probability underflows
  for (int i = 0; i < 100; ++i) {
    const double middle = 0.5 * (low + high);
    (chanceBeyond(middle) > chance ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

double lossOf(double residual, double scale) {
  const double z = residual / scale;
  return (kFreedom + 1.0) / 2.0 * std::log1p(z * z / kFreedom);
}

double pullOf(double residual, double scale) {
  return weightOf(residual, scale) * residual;
}

double weightOf(double residual, double scale) {
  return (kFreedom + 1.0) / (kFreedom * scale * scale + residual * residual);
}

Eigen::VectorXd activityOf(const std::vector<Observation>& data, const Eigen::VectorXd& predicted) {
  Eigen::VectorXd activity(predicted.size());
  for (size_t i = 0; i < data.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    // Rows along and across are consecutive, see Observations.
    if (data[i].channel == ObservedRate::kAlong)
      activity[at] = std::hypot(predicted[at], predicted[at + 1]);
    else if (data[i].channel == ObservedRate::kAcross)
      activity[at] = std::hypot(predicted[at - 1], predicted[at]);
    else
      activity[at] = std::abs(predicted[at]);
  }
  return activity;
}

Noise estimateNoise(const std::vector<Observation>& data, const Eigen::VectorXd& residuals,
                    const Eigen::VectorXd& activity, const std::vector<char>& mask) {
  std::array<ChannelResiduals, kChannels> channels;
  for (size_t i = 0; i < data.size(); ++i) {
    if (!mask[i]) continue;
    ChannelResiduals& channel = channels[static_cast<size_t>(data[i].channel)];
    channel.residual.push_back(residuals[static_cast<Eigen::Index>(i)]);
    channel.activity.push_back(activity[static_cast<Eigen::Index>(i)]);
  }
  Noise noise;
  for (size_t c = 0; c < kChannels; ++c)
    if (!channels[c].residual.empty()) noise[c] = estimated(channels[c]);
  return noise;
}

Eigen::VectorXd scalesOf(const std::vector<Observation>& data, const Noise& noise,
                         const Eigen::VectorXd& activity) {
  Eigen::VectorXd scales(activity.size());
  for (size_t i = 0; i < data.size(); ++i) {
    const ChannelNoise& of = noise[static_cast<size_t>(data[i].channel)];
    const auto at = static_cast<Eigen::Index>(i);
    scales[at] = std::hypot(of.still, of.share * activity[at]);
  }
  return scales;
}

double totalLoss(const Eigen::VectorXd& residuals, const Eigen::VectorXd& scales,
                 const std::vector<char>& mask) {
  double sum = 0.0;
  for (size_t i = 0; i < mask.size(); ++i)
    if (mask[i])
      sum += lossOf(residuals[static_cast<Eigen::Index>(i)], scales[static_cast<Eigen::Index>(i)]);
  return sum;
}

}  // namespace tread::gap
