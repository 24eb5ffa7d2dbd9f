// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "modules/mapping/core/ground_map.hpp"

using namespace tread;
using namespace tread::mapping;

namespace {

GroundPlane levelAt(double x, double z = 0.0) {
  return {{x, 0.0, z}, {0.0, 0.0}};
}

}  // namespace

TEST_CASE("one stand is extended as a plane, with a doubt that grows with distance") {
  GroundMap ground({}, 0.1, 256);
  ground.moveTo({-128, -128});
  const auto moved = ground.learn({{0.0, 0.0, 2.0}, {0.1, -0.05}});
  REQUIRE(moved.size() == 32 * 32);
  for (const CellIndex cell : {CellIndex{0, 0}, CellIndex{50, 20}, CellIndex{-77, 99}}) {
    const double x = (cell.x + 0.5) * 0.1;
    const double y = (cell.y + 0.5) * 0.1;
    REQUIRE(ground.at(cell).z == Approx(2.0 + 0.1 * x - 0.05 * y).margin(1e-9));
  }
  REQUIRE(ground.at({0, 0}).doubt < 0.03);
  REQUIRE(ground.at({100, 0}).doubt > 0.25);
}

TEST_CASE("driving nearer ends the doubt and brings the true height") {
  GroundMap ground({}, 0.1, 256);
  ground.moveTo({-128, -128});
  for (double x = 0.0; x < 8.0; x += 0.2) ground.learn(levelAt(x, x > 5.0 ? 0.3 : 0.0));
  REQUIRE(ground.at({78, 0}).z == Approx(0.3).margin(0.05));
  REQUIRE(ground.at({78, 0}).doubt < 0.03);
  REQUIRE(ground.at({20, 0}).z == Approx(0.0).margin(0.05));
}

TEST_CASE("a short pitch moves the ground far ahead little") {
  GroundMap ground({}, 0.1, 256);
  ground.moveTo({-128, -128});
  for (double x = 0.0; x < 6.0; x += 0.2) ground.learn(levelAt(x));
  ground.learn({{6.0, 0.0, 0.0}, {-0.09, 0.0}});
  ground.learn({{6.0, 0.0, 0.0}, {-0.09, 0.0}});
  REQUIRE(std::abs(ground.at({118, 0}).z) < 0.12);  // the plane itself gives -0.52
}

TEST_CASE("a patch that was driven over keeps its height when the robot has gone elsewhere") {
  GroundMap ground({}, 0.1, 256);
  ground.moveTo({-128, -128});
  for (double x = 0.0; x < 10.0; x += 0.2) ground.learn({{x, 0.0, 0.02 * x * x}, {0.04 * x, 0.0}});
  REQUIRE(ground.at({10, 0}).z == Approx(0.02).margin(0.05));
}

TEST_CASE("a height that drifts while the robot stands is followed under it") {
  GroundMap ground({}, 0.1, 256);
  ground.moveTo({-128, -128});
  for (int i = 0; i < 100; ++i) ground.learn(levelAt(0.4, 0.0));
  for (int i = 0; i < 30; ++i) ground.learn(levelAt(0.4, 0.5));
  REQUIRE(ground.at({4, 0}).z == Approx(0.5).margin(0.1));
}

TEST_CASE("patches that come into the window are told with the next stand") {
  GroundMap ground({}, 0.1, 256);
  ground.moveTo({-128, -128});
  ground.learn(levelAt(0.0));
  REQUIRE(ground.learn(levelAt(0.0)).empty());
  ground.moveTo({-96, -128});
  REQUIRE(ground.learn(levelAt(0.5)).size() >= 4 * 32);
  REQUIRE(ground.at({159, 0}).z == Approx(0.0).margin(1e-9));
}

TEST_CASE("a body on its side stands on no plane") {
  Eigen::Isometry3d T = Eigen::Isometry3d::Identity();
  REQUIRE(planeUnder(T));
  T.rotate(Eigen::AngleAxisd(1.5, Eigen::Vector3d::UnitX()));
  REQUIRE_FALSE(planeUnder(T));
}
