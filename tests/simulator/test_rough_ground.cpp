// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>
#include <memory>

#include "modules/simulator/core/robot.hpp"
#include "tests/simulator/shipped_robot.hpp"

using namespace tread;
using namespace tread::sim;

namespace {

RoughRegion fieldOfBumps(double rms = 0.02) {
  return {{{-30.0, -10.0}, {30.0, -10.0}, {30.0, 10.0}, {-30.0, 10.0}}, rms, 0.5, 2.0, 7};
}

std::shared_ptr<const World> bumpyWorld(double rms = 0.02) {
  WorldDescription description;
  description.base_surface = "tarmac";
  description.bounds = {{-40.0, -40.0}, {40.0, 40.0}};
  description.rough = {fieldOfBumps(rms)};
  return std::make_shared<const World>(description);
}

/// Straight over the bumps for 15 m.
RobotTruth driven(double power, double rms = 0.02) {
  RobotSettings settings = shippedRobot();
  settings.start = {-25.0, 0.0, 0.0};
  settings.motion_noise = false;
  SimulatedRobot robot(bumpyWorld(rms), settings);
  robot.setPower({power, power});
  for (int64_t t = 0; t < 60'000'000 && robot.truth().distance < 15.0; t += 100'000)
    robot.advanceTo(t);
  return robot.truth();
}

}  // namespace

TEST_CASE("bumps have the height that they were asked for, and none outside of their region") {
  const auto world = bumpyWorld();
  double squares = 0.0;
  int count = 0;
  for (double x = -29.0; x < 29.0; x += 0.21)
    for (double y = -9.0; y < 9.0; y += 0.23, ++count)
      squares += std::pow(world->height({x, y}), 2);
  CHECK(std::sqrt(squares / count) == Approx(0.02).epsilon(0.15));
  CHECK(world->height({0.0, 10.01}) == 0.0);
  CHECK(std::abs(world->height({0.0, 9.999})) < 1e-4);
  CHECK(world->isRough({0.0, 9.0}));
  CHECK_FALSE(world->isRough({0.0, 11.0}));
}

TEST_CASE("a beam at the ground ends on the bumps") {
  const auto world = bumpyWorld(0.03);
  for (int i = 0; i < 200; ++i) {
    const Eigen::Vector3d start(-20.0 + 0.1 * i, 0.02 * i, 0.6);
    const Eigen::Vector3d direction = Eigen::Vector3d(1.0, 0.3 * std::sin(i), -0.25).normalized();
    const auto distance = world->castRay(start, direction, 15.0);
    REQUIRE(distance);
    const Eigen::Vector3d hit = start + *distance * direction;
    CHECK(std::abs(hit.z() - world->height(hit.head<2>())) < 0.01);
  }
}

TEST_CASE("a rigid vehicle bridges bumps that are shorter than itself") {
  WorldDescription description;
  description.rough = {fieldOfBumps()};
  description.rough[0].shortest = 0.15;
  description.rough[0].longest = 0.3;
  const World fine(description);
  const auto coarse = bumpyWorld();
  const FootprintSize contact{0.2, 0.36, 0.215};
  double fine_squares = 0.0, coarse_squares = 0.0;
  for (double x = -20.0; x < 20.0; x += 0.3) {
    fine_squares += std::pow(fine.bearing({x, 0.0, 0.4}, contact).height, 2);
    coarse_squares += std::pow(coarse->bearing({x, 0.0, 0.4}, contact).height, 2);
  }
  CHECK(fine_squares < 0.3 * coarse_squares);
}

TEST_CASE("shock grows with the speed and with the height of the bumps", "[statistics]") {
  const Shaking fast = driven(1.0).rough, slow = driven(0.5).rough, low = driven(1.0, 0.01).rough;
  const auto shock = [](const Shaking& s) { return s.rms(s.acceleration_sum); };
  const auto pitch = [](const Shaking& s) { return s.rms(s.pitch_rate_sum); };
  CHECK(shock(fast) > 2.5 * shock(slow));
  CHECK(pitch(fast) > 1.5 * pitch(slow));
  CHECK(shock(fast) > 1.6 * shock(low));
  CHECK(fast.acceleration_peak > 2.0 * shock(fast));
  CHECK(driven(1.0).smooth.time == 0.0);
}
