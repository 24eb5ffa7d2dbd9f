// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/core/scaling.hpp"

#include <algorithm>
#include <cmath>

namespace tread::learner {

TrajectoryTable::TrajectoryTable(const std::vector<MotionPattern>& patterns) {
  begins_.push_back(0);
  for (const MotionPattern& pattern : patterns)
    begins_.push_back(begins_.back() + 3 * static_cast<Eigen::Index>(pattern.trajectory.size()));
  numbers_.resize(static_cast<size_t>(begins_.back()));
  std::vector<double> numbers;
  for (size_t p = 0; p < patterns.size(); ++p) {
    fill(patterns[p].trajectory, numbers);
    std::copy(numbers.begin(), numbers.end(), numbers_.begin() + begins_[p]);
  }
}

Pose2 TrajectoryTable::end(size_t pattern) const {
  const ConstTrajectory trajectory = of(pattern);
  const Eigen::Index last = trajectory.rows() - 1;
  return {trajectory(last, 0), trajectory(last, 1), trajectory(last, 2)};
}

void TrajectoryTable::copyNumbers(const TrajectoryTable& other) {
  std::copy(other.numbers_.begin(), other.numbers_.end(), numbers_.begin());
}

void fill(const std::vector<Pose2>& poses, std::vector<double>& numbers) {
  const size_t samples = poses.size();
  numbers.resize(3 * samples);
  for (size_t t = 0; t < samples; ++t) {
    numbers[t] = poses[t].x;
    numbers[samples + t] = poses[t].y;
    numbers[2 * samples + t] = poses[t].yaw;
  }
}

std::vector<Pose2> posesOf(const ConstTrajectory& trajectory) {
  std::vector<Pose2> poses;
  poses.reserve(static_cast<size_t>(trajectory.rows()));
  for (Eigen::Index t = 0; t < trajectory.rows(); ++t)
    poses.push_back({trajectory(t, 0), trajectory(t, 1), trajectory(t, 2)});
  return poses;
}

namespace {

/// A smaller box cannot be a divisor [m, rad].
constexpr double kTiniestBox = 1e-6;

/// Variances of x, y, yaw within xx xy xyaw yy yyaw yawyaw.
Axes variances(const PoseCovariance& covariance) {
  return {covariance[0], covariance[3], covariance[5]};
}

}  // namespace

Axes boundingBox(const ConstTrajectory& trajectory) {
  Axes box;
  for (Eigen::Index axis = 0; axis < 3; ++axis)
    box[axis] = std::max(trajectory.col(axis).maxCoeff(), 0.0) -
                std::min(trajectory.col(axis).minCoeff(), 0.0);
  return box;
}

PatternRole roleOf(const MotionPattern& shipped, const ScalingLimits& limits) {
  const Axes box = boundingBox(shipped.trajectory);
  const Axes variance = variances(shipped.end_covariance);
  PatternRole role;
  for (int axis = 0; axis < 3; ++axis) {
    const bool known = std::isfinite(variance[axis]) && variance[axis] >= 0.0;
    const double noise = known ? limits.min_box_sigmas * std::sqrt(variance[axis]) : 0.0;
    role.scalable[static_cast<size_t>(axis)] = box[axis] >= std::max(limits.min_box[axis], noise);
  }
  // Section IV: one-dimensional motion (straight driving, turns in place) gives no V.
  role.gives_scaling = std::count(role.scalable.begin(), role.scalable.end(), true) >= 2;
  return role;
}

Axes scalingVector(const Axes& new_box, const Axes& old_box, const PatternRole& role,
                   const ScalingLimits& limits) {
  Axes factors = Axes::Ones();
  for (int axis = 0; axis < 3; ++axis) {
    if (!role.scalable[static_cast<size_t>(axis)] || old_box[axis] < kTiniestBox) continue;
    factors[axis] = std::clamp(new_box[axis] / old_box[axis], limits.min_factor,
                               limits.max_factor);  // equation (1)
  }
  return factors;
}

void scale(const Axes& factors, const PatternRole& role, Trajectory predicted) {
  for (int axis = 0; axis < 3; ++axis)
    if (role.scalable[static_cast<size_t>(axis)]) predicted.col(axis) *= factors[axis];
}

void smooth(const ConstTrajectory& measured, double memory, Trajectory predicted) {
  predicted = (1.0 - memory) * measured + memory * predicted;  // equation (2)
}

bool isKnown(const PoseCovariance& covariance) {
  const bool finite = std::all_of(covariance.begin(), covariance.end(),
                                  [](double element) { return std::isfinite(element); });
  // Nothing is certain: variances that are all zero come from a model without spread.
  return finite && (covariance[0] > 0.0 || covariance[3] > 0.0 || covariance[5] > 0.0);
}

}  // namespace tread::learner
