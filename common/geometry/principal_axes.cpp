// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/geometry/principal_axes.hpp"

#include <Eigen/Eigenvalues>

namespace tread {

PrincipalAxes principalAxes(const Eigen::Matrix2d& covariance) {
  Eigen::SelfAdjointEigenSolver<Eigen::Matrix2d> solver;
  solver.computeDirect(covariance);
  return {solver.eigenvalues(), solver.eigenvectors()};
}

}  // namespace tread
