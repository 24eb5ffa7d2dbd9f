// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>
#include <random>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include <Eigen/Core>

#include "common/vehicle/kernel.hpp"
#include "common/vehicle/model_file.hpp"

using namespace tread;

namespace {

const VehicleModel& grass() {
  static const VehicleModel model =
      readModelFile(std::string(TREAD_SOURCE_DIR) + "/config/models/teodor_grass.yaml");
  return model;
}

Eigen::Matrix3d sampled(const std::vector<TrackCommand>& commands, const EntryState& entry) {
  std::mt19937_64 random(11);
  const Pose2 mean = simulate(grass(), commands, 0.05, entry).back();
  Eigen::Matrix3d sum = Eigen::Matrix3d::Zero();
  constexpr int kDraws = 4000;
  for (int i = 0; i < kDraws; ++i) {
    const ExecutionNoise noise = drawNoise(grass().spread, random);
    const Pose2 end = simulate(grass(), commands, 0.05, entry, noise).back();
    const Eigen::Vector3d off(end.x - mean.x, end.y - mean.y, end.yaw - mean.yaw);
    sum += off * off.transpose();
  }
  return sum / kDraws;
}

}  // namespace

TEST_CASE("The end covariance is that of many drawn executions") {
  const std::vector<TrackCommand> commands(20, {0.8, 1.0});
  const EntryState entry = steadyEntry(grass(), {1.0, 1.0});
  const PoseCovariance covariance = endCovariance(grass(), commands, 0.05, entry);
  const Eigen::Matrix3d expected = sampled(commands, entry);
  CHECK(covariance[0] == Approx(expected(0, 0)).epsilon(0.06));
  CHECK(covariance[3] == Approx(expected(1, 1)).epsilon(0.06));
  CHECK(covariance[5] == Approx(expected(2, 2)).epsilon(0.06));
  const double scale = std::sqrt(expected(1, 1) * expected(2, 2));
  CHECK(std::abs(covariance[4] - expected(1, 2)) < 0.06 * scale);
}

TEST_CASE("A predicted pattern begins in its class and says how sure it is") {
  const MotionClass cruise = classOf(grass(), "cruise", {1.0, 1.0});
  CHECK(cruise.twist.v_x == Approx(1.1 * 1.046));
  CHECK(cruise.twist.omega == 0.0);
  MotionPattern pattern;
  pattern.commands.assign(20, {1.0, 1.0});
  predict(grass(), 0.05, cruise, pattern);
  REQUIRE(pattern.trajectory.size() == 20);
  CHECK(pattern.end().x == Approx(cruise.twist.v_x).epsilon(1e-9));
  CHECK(pattern.end_covariance[0] > 0.0);
  CHECK(pattern.end_covariance[5] == 0.0);
}

TEST_CASE("A pattern without commands has no covariance") {
  CHECK(std::isnan(endCovariance(grass(), {}, 0.05, {})[0]));
}
