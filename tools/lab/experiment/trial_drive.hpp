// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <cmath>
#include <random>
#include <vector>

#include "tools/lab/experiment/trials.hpp"

namespace tread::experiment {

inline double positionError(const Pose2& predicted, const Pose2& driven) {
  const double dx = predicted.x - driven.x;
  const double dy = predicted.y - driven.y;
  return std::sqrt(dx * dx + dy * dy);
}

inline double orientationError(const Pose2& predicted, const Pose2& driven) {
  const double difference = std::abs(predicted.yaw - driven.yaw);
  return difference <= kPi ? difference : std::abs(wrapAngle(difference));
}

/// Randomly drawn executions, and the errors of all methods since the last clear().
class TrialDrive {
 public:
  TrialDrive(Methods& methods, const TrialSite& site)
      : methods_(methods),
        site_(site),
        random_(site.seed),
        position_(methods.size()),
        orientation_(methods.size()) {
    for (const Executions& executions : site.to.tests)
      joined_.resize(std::max(joined_.size(), 3 * executions.samples()));
  }

  void clear() {
    metres_ = radians_ = 0.0;
    std::fill(position_.begin(), position_.end(), 0.0);
    std::fill(orientation_.begin(), orientation_.end(), 0.0);
  }
  void addTo(MethodErrors& errors) const {
    errors.position.add(metres_, position_.data());
    errors.orientation.add(radians_, orientation_.data());
  }

  /// One execution on the new surface; each(method, position error, orientation error, end).
  template <class Each>
  void execute(size_t pattern, bool learn, const Each& each) {
    const Executions& executions = site_.to.tests[pattern];
    const size_t index = drawIndex(random_, executions.size());
    score(pattern, executions.of(index), executions.endOf(index), learn, each);
  }
  void execute(size_t pattern, bool learn) {
    execute(pattern, learn, [](size_t, double, double, const ExecutionEnd&) {});
  }

  /// A random pattern.
  size_t any() { return drawIndex(random_, site_.to.tests.size()); }

  /// The first execution after the transition.
  template <class Each>
  void executeFirst(size_t pattern, bool learn, const Each& each) {
    if (!site_.change_inside) return execute(pattern, learn, each);
    const learner::ConstTrajectory measured = joinedAt(pattern);
    score(pattern, measured, executionEnd(measured), learn, each);
  }
  void executeFirst(size_t pattern, bool learn) {
    executeFirst(pattern, learn, [](size_t, double, double, const ExecutionEnd&) {});
  }

 private:
  template <class Each>
  void score(size_t pattern, const learner::ConstTrajectory& measured, const ExecutionEnd& end,
             bool learn, const Each& each) {
    metres_ += end.metres;
    radians_ += end.radians;
    for (size_t i = 0; i < methods_.size(); ++i) {
      const Pose2 predicted = methods_.predictEnd(i, pattern);
      const double position = positionError(predicted, end.pose);
      const double orientation = orientationError(predicted, end.pose);
      position_[i] += position;
      orientation_[i] += orientation;
      each(i, position, orientation, end);
      if (learn) methods_.learn(i, pattern, measured);
    }
  }

  /// First half of an execution on the old surface, continued by the second half of one on the new
  /// surface.
  learner::ConstTrajectory joinedAt(size_t pattern) {
    const Executions& before = site_.from.tests[pattern];
    const Executions& after = site_.to.tests[pattern];
    const learner::ConstTrajectory first = before.of(drawIndex(random_, before.size()));
    const learner::ConstTrajectory second = after.of(drawIndex(random_, after.size()));
    const Eigen::Index samples = first.rows(), half = samples / 2;
    learner::Trajectory joined(joined_.data(), samples, 3);
    joined.topRows(half) = first.topRows(half);
    const auto poseAt = [](const learner::ConstTrajectory& of, Eigen::Index row) {
      return row < 0 ? Pose2{} : Pose2{of(row, 0), of(row, 1), of(row, 2)};
    };
    const Pose2 T_start_change = poseAt(first, half - 1);
    const Pose2 T_other_change = poseAt(second, half - 1);
    for (Eigen::Index row = half; row < samples; ++row) {
      const Pose2 pose = T_start_change * between(T_other_change, poseAt(second, row));
      joined.row(row) << pose.x, pose.y, pose.yaw;
    }
    return {joined_.data(), samples, 3};
  }

  Methods& methods_;
  const TrialSite& site_;
  std::mt19937_64 random_;
  double metres_ = 0.0;
  double radians_ = 0.0;
  std::vector<double> position_;
  std::vector<double> orientation_;
  std::vector<double> joined_;
};

}  // namespace tread::experiment
