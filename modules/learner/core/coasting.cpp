// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/core/coasting.hpp"

#include <algorithm>
#include <cmath>

namespace tread::learner {
namespace {

constexpr double kWindow = 0.2;      // [s] over which d is measured
constexpr double kGone = 0.5;        // [s]
constexpr double kExpected = 0.2;    // [s] tau_0
constexpr double kLongest = 1.0;     // [s] tau at most
constexpr double kCertainty = 0.05;  // [1] L over the square of the fastest
constexpr double kMost = 0.5;        // [1] of the fastest: upper limit of d
constexpr double kFading = 0.99;     // [1] of the sums, per execution

double share(double seconds) {
  return 1.0 - std::exp(-seconds / kGone);
}

/// Mean velocity between two samples, in the body frame at the middle: the chord of an arc [m/s].
Eigen::Vector2d velocityIn(const std::vector<Pose2>& poses, size_t from, size_t to,
                           double seconds) {
  const double dx = poses[to].x - poses[from].x;
  const double dy = poses[to].y - poses[from].y;
  const double yaw = 0.5 * (poses[from].yaw + poses[to].yaw);
  const double c = std::cos(yaw);
  const double s = std::sin(yaw);
  return Eigen::Vector2d(c * dx + s * dy, c * dy - s * dx) / seconds;
}

}  // namespace

Coasting::Coasting(double fastest) : fastest_(fastest) {}

std::optional<Eigen::Vector2d> Coasting::beside(const std::vector<Pose2>& measured,
                                                const std::vector<Pose2>& predicted, size_t samples,
                                                double period) const {
  const auto window = static_cast<size_t>(std::max(1.0, std::round(kWindow / period)));
  if (samples <= window || samples > measured.size() || samples > predicted.size())
    return std::nullopt;
  const size_t to = samples - 1;
  const double seconds = period * static_cast<double>(window);
  const Eigen::Vector2d d = velocityIn(measured, to - window, to, seconds) -
                            velocityIn(predicted, to - window, to, seconds);
  if (!d.allFinite()) return std::nullopt;
  const double most = kMost * fastest_;
  return d.cwiseMax(-most).cwiseMin(most).eval();
}

double Coasting::tau() const {
  // A set without motion cannot coast.
  const double certainty = std::max(1e-12, kCertainty * fastest_ * fastest_);
  return std::clamp((certainty * kExpected + products_) / (certainty + squares_), 0.0, kLongest);
}

void Coasting::learn(const Eigen::Vector2d& beside, const Eigen::Vector2d& error, double seconds) {
  if (!beside.allFinite() || !error.allFinite()) return;
  const double s = share(seconds);
  products_ = kFading * products_ + s * beside.dot(error);
  squares_ = kFading * squares_ + s * s * beside.squaredNorm();
}

void Coasting::restore(const std::array<double, kNumbers>& memory) {
  products_ = memory[0];
  squares_ = memory[1];
}

void Coasting::add(const Eigen::Vector2d& beside, double period, std::vector<Pose2>& poses) const {
  const Eigen::Vector2d way = tau() * beside;
  for (size_t t = 0; t < poses.size(); ++t) {
    const double s = share(period * static_cast<double>(t + 1));
    poses[t].x += s * way[0];
    poses[t].y += s * way[1];
  }
}

}  // namespace tread::learner
