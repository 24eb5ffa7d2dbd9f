// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/likelihood.hpp"

#include <algorithm>
#include <cmath>

namespace tread::gap {
namespace {

constexpr double kLeastScale = 1e-6;  // [rad/s or m/s], of residuals that are all 0

/// Residuals of one channel with what goes on in their rows.
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
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return std::max(kLeastScale, *middle);
}

/// Least negative log likelihood by steps along either logarithm, halved when none helps.
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
      if (loss >= least - 1e-9) continue;
      least = loss;
      best = tried;
      better = true;
    }
    if (!better) step /= 2.0;
  }
  return best;
}

}  // namespace

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

Eigen::VectorXd activityOf(const std::vector<Row>& rows, const Eigen::VectorXd& predicted) {
  Eigen::VectorXd activity(predicted.size());
  for (size_t i = 0; i < rows.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    // Rows along and across follow one another, see Rows.
    if (rows[i].channel == Channel::kAlong)
      activity[at] = std::hypot(predicted[at], predicted[at + 1]);
    else if (rows[i].channel == Channel::kAcross)
      activity[at] = std::hypot(predicted[at - 1], predicted[at]);
    else
      activity[at] = std::abs(predicted[at]);
  }
  return activity;
}

Noise estimateNoise(const std::vector<Row>& rows, const Eigen::VectorXd& residuals,
                    const Eigen::VectorXd& activity, const std::vector<char>& mask) {
  std::array<ChannelResiduals, kChannels> channels;
  for (size_t i = 0; i < rows.size(); ++i) {
    if (!mask[i]) continue;
    ChannelResiduals& channel = channels[static_cast<size_t>(rows[i].channel)];
    channel.residual.push_back(residuals[static_cast<Eigen::Index>(i)]);
    channel.activity.push_back(activity[static_cast<Eigen::Index>(i)]);
  }
  Noise noise;
  for (size_t c = 0; c < kChannels; ++c)
    if (!channels[c].residual.empty()) noise[c] = estimated(channels[c]);
  return noise;
}

Eigen::VectorXd scalesOf(const std::vector<Row>& rows, const Noise& noise,
                         const Eigen::VectorXd& activity) {
  Eigen::VectorXd scales(activity.size());
  for (size_t i = 0; i < rows.size(); ++i) {
    const ChannelNoise& of = noise[static_cast<size_t>(rows[i].channel)];
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
