// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <random>

#include <catch2/catch.hpp>

#include "common/geometry/se3.hpp"

namespace tread {
namespace {

/// R = Rz(yaw) Ry(pitch) Rx(roll) by Eigen, as an oracle for MRPT's.
Eigen::Matrix3d rotation(const YawPitchRoll& angles) {
  using Eigen::AngleAxisd;
  using Eigen::Vector3d;
  return (AngleAxisd(angles.yaw, Vector3d::UnitZ()) * AngleAxisd(angles.pitch, Vector3d::UnitY()) *
          AngleAxisd(angles.roll, Vector3d::UnitX()))
      .toRotationMatrix();
}

}  // namespace

TEST_CASE("a transform from yaw, pitch and roll turns about z, then y, then x") {
  std::mt19937_64 random(23);
  std::uniform_real_distribution<double> angle(-3.0, 3.0);
  for (int i = 0; i < 100; ++i) {
    const YawPitchRoll angles{angle(random), angle(random), angle(random)};
    const Eigen::Isometry3d T = isometryFrom({1.0, 2.0, 3.0}, angles);
    CHECK(T.linear().isApprox(rotation(angles), 1e-12));
    CHECK(T.translation() == Eigen::Vector3d(1.0, 2.0, 3.0));
  }
}

TEST_CASE("yaw, pitch and roll come back from a rotation") {
  std::mt19937_64 random(29);
  std::uniform_real_distribution<double> turn(-3.1, 3.1);
  std::uniform_real_distribution<double> nod(-1.5, 1.5);
  for (int i = 0; i < 100; ++i) {
    const YawPitchRoll angles{turn(random), nod(random), turn(random)};
    const YawPitchRoll back = yawPitchRoll(Eigen::Quaterniond(rotation(angles)));
    CHECK(back.yaw == Approx(angles.yaw).margin(1e-9));
    CHECK(back.pitch == Approx(angles.pitch).margin(1e-9));
    CHECK(back.roll == Approx(angles.roll).margin(1e-9));
  }
}

TEST_CASE("nose down is positive pitch, left side up is positive roll") {
  const Eigen::Vector3d nose = rotation({0.0, 0.2, 0.0}) * Eigen::Vector3d::UnitX();
  CHECK(nose.z() < 0.0);
  CHECK(yawPitchRoll(Eigen::Quaterniond(rotation({0.0, 0.2, 0.0}))).pitch == Approx(0.2));
  const Eigen::Vector3d left = rotation({0.0, 0.0, 0.2}) * Eigen::Vector3d::UnitY();
  CHECK(left.z() > 0.0);
}

TEST_CASE("straight up and straight down still give a rotation that is the same") {
  for (const double pitch : {kPi / 2.0, -kPi / 2.0}) {
    const Eigen::Matrix3d R = rotation({0.7, pitch, 0.0});
    const YawPitchRoll back = yawPitchRoll(Eigen::Quaterniond(R));
    CHECK(rotation(back).isApprox(R, 1e-6));
  }
}

TEST_CASE("a quaternion need not be of unit length, and its sign does not matter") {
  Eigen::Quaterniond q(rotation({1.0, 0.1, 0.2}));
  q.coeffs() *= -1.001;
  CHECK(yawPitchRoll(q).yaw == Approx(1.0));
}

TEST_CASE("the planar pose keeps x, y and yaw of a tilted body") {
  const Pose2 pose = planar({4.0, 5.0, 6.0}, Eigen::Quaterniond(rotation({-2.5, 0.3, -0.2})));
  CHECK(pose.x == 4.0);
  CHECK(pose.y == 5.0);
  CHECK(pose.yaw == Approx(-2.5));
}

}  // namespace tread
