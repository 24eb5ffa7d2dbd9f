// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "common/recordings/sessions.hpp"

using namespace tread;
using namespace tread::recordings;

namespace {

const TwistLine kTurn{{2.1, -0.2, 0.9}, {0.1, 0.05, -0.15}};

/// Poses every 0.2 s of a profile, in a map in which the window begins anywhere.
std::vector<PoseSample> drivenPoses(const TwistLine& profile) {
  const Pose2 T_map_start{3.0, -2.0, 2.5};
  const std::vector<Pose2> fine = integrated(profile, 400, 0.005);
  std::vector<PoseSample> poses;
  for (size_t i = 20; i <= 400; i += 40) poses.push_back({0.005 * static_cast<double>(i), {}});
  for (PoseSample& pose : poses)
    pose.T_map_body = T_map_start * fine[static_cast<size_t>(std::lround(pose.time / 0.005)) - 1];
  return poses;
}

void requireNear(const TwistLine& a, const TwistLine& b, double tolerance) {
  INFO(a.vector().transpose() << " against " << b.vector().transpose());
  REQUIRE((a.vector() - b.vector()).cwiseAbs().maxCoeff() < tolerance);
}

}  // namespace

TEST_CASE("smoothing recovers a twist that changes linearly from poses of a window") {
  requireNear(smoothed(drivenPoses(kTurn), 2.0), kTurn, 1e-4);
  const TwistLine spin{{0.05, -0.1, -1.4}, {0.0, 0.0, 0.2}};
  requireNear(smoothed(drivenPoses(spin), 2.0), spin, 1e-4);
}

TEST_CASE("a pose that jumped hardly moves the smoothed twist") {
  std::vector<PoseSample> poses = drivenPoses(kTurn);
  poses[4].T_map_body.x += 1.0;
  poses[6].T_map_body.yaw += 0.5;
  const TwistLine found = smoothed(poses, 2.0);
  CHECK(std::abs(found.mean.v_x - kTurn.mean.v_x) < 0.02);
  CHECK(std::abs(found.mean.v_y - kTurn.mean.v_y) < 0.02);
  CHECK(std::abs(found.mean.omega - kTurn.mean.omega) < 0.02);
}

TEST_CASE("mirrored poses smooth to the mirrored twist") {
  std::vector<PoseSample> poses = drivenPoses(kTurn);
  poses[3].T_map_body.y += 0.3;
  const TwistLine straight = smoothed(poses, 2.0);
  for (PoseSample& pose : poses) {
    pose.T_map_body.y = -pose.T_map_body.y;
    pose.T_map_body.yaw = -pose.T_map_body.yaw;
  }
  requireNear(smoothed(poses, 2.0), straight.mirrored(), 1e-9);
}

TEST_CASE("a window with a gap or with too few poses is refused in words") {
  std::vector<PoseSample> poses = drivenPoses(kTurn);
  REQUIRE(windowProblem(poses, 2.0).empty());
  poses.erase(poses.begin() + 3, poses.begin() + 5);
  REQUIRE(windowProblem(poses, 2.0) == "no new pose for more than 0.40 s");
  REQUIRE_FALSE(windowProblem({}, 2.0).empty());
  // The end of the window must be used, too.
  poses = drivenPoses(kTurn);
  poses.resize(poses.size() - 2);
  REQUIRE_FALSE(windowProblem(poses, 2.0).empty());
}

TEST_CASE("a robust line through points of which a quarter is wrong is the line") {
  Eigen::MatrixXd A(40, 2);
  Eigen::VectorXd b(40);
  for (int i = 0; i < 40; ++i) {
    A.row(i) << 1.0, i;
    b[i] = 2.0 + 0.5 * i + (i % 2 == 0 ? 0.01 : -0.01) + (i % 4 == 0 ? 50.0 : 0.0);
  }
  const Eigen::VectorXd line = huberFit(A, b, Eigen::VectorXd::Ones(40), {1, 0.001});
  CHECK(std::abs(line[0] - 2.0) < 0.03);
  CHECK(std::abs(line[1] - 0.5) < 0.002);
}
