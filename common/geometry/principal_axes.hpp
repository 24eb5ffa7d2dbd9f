// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <Eigen/Core>

namespace tread {

/// Eigenvalues and eigenvectors of a symmetric matrix, such as the covariance of a position.
struct PrincipalAxes {
  Eigen::Vector2d variances;   ///< in increasing order
  Eigen::Matrix2d directions;  ///< column i: unit vector along which the variance is variances[i]
};

/// In closed form and compiled once: Eigen's iteration takes five seconds in each file that calls
/// it.
PrincipalAxes principalAxes(const Eigen::Matrix2d& covariance);

}  // namespace tread
