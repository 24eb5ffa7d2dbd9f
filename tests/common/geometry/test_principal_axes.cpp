// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>

#include <Eigen/Geometry>
#include <catch2/catch.hpp>

#include "common/geometry/principal_axes.hpp"

namespace tread {

TEST_CASE("principal axes of an ellipse are its half axes squared and their directions") {
  for (const double yaw : {0.0, 0.3, -1.2, 2.0, 0.5 * M_PI}) {
    for (const double across : {0.0, 1e-12, 0.5, 4.0}) {
      CAPTURE(yaw, across);
      const Eigen::Matrix2d R = Eigen::Rotation2Dd(yaw).toRotationMatrix();
      const Eigen::Matrix2d covariance =
          R * Eigen::Vector2d(4.0, across).asDiagonal() * R.transpose();
      const PrincipalAxes axes = principalAxes(covariance);
      CHECK(axes.variances[0] == Approx(across).margin(1e-14));
      CHECK(axes.variances[1] == Approx(4.0));
      const Eigen::Matrix2d again =
          axes.directions * axes.variances.asDiagonal() * axes.directions.transpose();
      CHECK((again - covariance).norm() < 1e-14);
    }
  }
}

}  // namespace tread
