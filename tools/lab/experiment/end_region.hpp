// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <Eigen/Cholesky>
#include <Eigen/Core>

#include "common/geometry/se2.hpp"
#include "common/pattern/pattern.hpp"

namespace tread::experiment {

/// Whether a measured end is inside the 90 % region of a covariance.
inline bool isInside(const Pose2& predicted, const Pose2& measured,
                     const PoseCovariance& covariance) {
  constexpr double kQuantile = 6.251;  // chi^2, three degrees of freedom
  Eigen::Matrix3d P;
  P << covariance[0], covariance[1], covariance[2], covariance[1], covariance[3], covariance[4],
      covariance[2], covariance[4], covariance[5];
  const Eigen::Vector3d apart(measured.x - predicted.x, measured.y - predicted.y,
                              wrapAngle(measured.yaw - predicted.yaw));
  const Eigen::LLT<Eigen::Matrix3d> root(P);
  return root.info() == Eigen::Success && apart.dot(root.solve(apart)) < kQuantile;
}

}  // namespace tread::experiment
