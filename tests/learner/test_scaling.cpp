// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "modules/learner/core/scaling.hpp"
#include "tests/learner/samples.hpp"

using namespace tread;
using namespace tread::learner;
using namespace tread::learner::samples;

namespace {

constexpr PatternRole kAllAxes{{true, true, true}, true};

/// V of equation (1) from two trajectories.
Axes quotient(const std::vector<Pose2>& measured, const std::vector<Pose2>& predicted,
              const PatternRole& role = kAllAxes) {
  return scalingVector(boundingBox(measured), boundingBox(predicted), role, {});
}

/// Poses that can be modified in place.
struct Numbers {
  explicit Numbers(const std::vector<Pose2>& poses) { fill(poses, numbers); }
  Trajectory trajectory() {
    return {numbers.data(), static_cast<Eigen::Index>(numbers.size() / 3), 3};
  }
  ConstTrajectory fixed() const {
    return {numbers.data(), static_cast<Eigen::Index>(numbers.size() / 3), 3};
  }
  Pose2 end() const { return posesOf(fixed()).back(); }
  std::vector<double> numbers;
};

}  // namespace

TEST_CASE("the bounding box contains the start pose") {
  // Without it the first trajectory would be 0.3 m long, not 0.5 m, and the reverse one 0.4 m.
  const Axes forward = boundingBox({{0.2, 0.1, 0.2}, {0.5, -0.05, 0.4}});
  REQUIRE(forward[0] == Approx(0.5));
  REQUIRE(forward[1] == Approx(0.15));
  REQUIRE(forward[2] == Approx(0.4));
  const Axes reverse = boundingBox({{-0.1, 0.0, -0.1}, {-0.5, 0.2, -0.3}});
  REQUIRE(reverse[0] == Approx(0.5));
  REQUIRE(reverse[1] == Approx(0.2));
  REQUIRE(reverse[2] == Approx(0.3));
}

TEST_CASE("equation (1): V is the quotient of length, width and yaw interval") {
  const std::vector<Pose2> predicted{{0.5, 0.1, 0.3}, {1.0, 0.4, 0.8}};
  const std::vector<Pose2> measured{{0.4, 0.2, 0.4}, {0.8, 0.6, 1.2}};
  const Axes V = quotient(measured, predicted);
  REQUIRE(V[0] == Approx(0.8));
  REQUIRE(V[1] == Approx(1.5));
  REQUIRE(V[2] == Approx(1.5));
}

TEST_CASE("a double lane change is compared by its width, not by its lateral end") {
  const std::vector<Pose2> predicted{{0.5, 0.4, 0.6}, {1.0, 0.001, 0.0}};
  const std::vector<Pose2> measured{{0.5, 0.5, 0.6}, {1.0, 0.02, 0.0}};
  REQUIRE(quotient(measured, predicted)[1] == Approx(1.25));
}

TEST_CASE("factors stay between one half and two, whatever was measured") {
  const std::vector<Pose2> predicted{{1.0, 0.3, 0.2}};
  const Axes V = quotient({{0.1, 3.0, 0.5}}, predicted);
  REQUIRE(V[0] == 0.5);
  REQUIRE(V[1] == 2.0);
  REQUIRE(V[2] == 2.0);
}

TEST_CASE("a box that has shrunk to nothing is not divided by") {
  const Axes V = quotient({{1.0, 0.1, 0.1}}, {{0.0, 0.0, 0.0}});
  REQUIRE((V == 1.0).all());
}

TEST_CASE("an axis whose box is noise in the shipped set keeps the factor one for good") {
  // 1.9 cm wide, 0.029 rad: below both limits; the length is not.
  const MotionPattern weak = pattern(1, "weak", {1.0, 1.0}, {{1.0, 0.019, 0.029}});
  const PatternRole role = roleOf(weak, {});
  REQUIRE(role.scalable == std::array<bool, 3>{true, false, false});
  const Axes V = quotient({{1.2, 0.3, 0.3}}, weak.trajectory, role);
  REQUIRE(V[0] == Approx(1.2));
  REQUIRE(V[1] == 1.0);
  REQUIRE(V[2] == 1.0);
  Numbers numbers(weak.trajectory);
  scale({1.5, 1.5, 1.5}, role, numbers.trajectory());
  const Pose2 end = numbers.end();
  REQUIRE(end.x == Approx(1.5));
  REQUIRE(end.y == 0.019);
  REQUIRE(end.yaw == 0.029);
}

TEST_CASE("an axis is usable only where its box exceeds three recorded standard deviations") {
  MotionPattern left = pattern(1, "left", {0.7, 1.0}, {{0.9, 0.2, 0.5}});
  left.end_covariance = {0.01, 0.0, 0.0, 0.0049, 0.0, 0.0225};  // 0.10 m, 0.07 m, 0.15 rad
  REQUIRE(roleOf(left, {}).scalable == std::array<bool, 3>{true, false, true});
}

TEST_CASE("straight and in-place patterns are one-dimensional, arcs are not") {
  const PatternSet set = smallSet();
  REQUIRE_FALSE(roleOf(*set.find(kStraight), {}).gives_scaling);
  REQUIRE_FALSE(roleOf(*set.find(kSpin), {}).gives_scaling);
  REQUIRE_FALSE(roleOf(*set.find(kReverse), {}).gives_scaling);
  REQUIRE(roleOf(*set.find(kLeft), {}).gives_scaling);
  REQUIRE(roleOf(*set.find(kRight), {}).gives_scaling);
}

TEST_CASE("what moves in two dimensions gives scaling, whether it turns or not") {
  const auto gives = [](const Pose2& end, const PoseCovariance& covariance = {}) {
    MotionPattern one = pattern(1, "one", {1.0, 1.0}, {end});
    one.end_covariance = covariance;
    return roleOf(one, {}).gives_scaling;
  };
  CHECK(gives({0.10, 0.10, 0.0}));   // diagonal
  CHECK(gives({-0.1, 0.03, 0.01}));  // backward and to the left
  CHECK(gives({0.0, 0.10, 0.05}));   // sideways, turning
  CHECK_FALSE(gives({0.2, 0.01, 0.02}));
  CHECK_FALSE(gives({0.0, 0.2, 0.02}));
  CHECK_FALSE(gives({0.01, 0.01, 0.5}));
  // Three recorded deviations exceed the box: its sideways motion is noise.
  CHECK_FALSE(gives({0.2, 0.1, 0.0}, {1e-4, 0.0, 0.0, 0.0016, 0.0, 1e-4}));
}

TEST_CASE("equation (2): memory is the weight of the old prediction") {
  // w = 0.3: 0.7 of the measurement and 0.3 of the prediction; the paper's line 13 would reverse
  // the two.
  Numbers measured({{1.0, 0.5, 1.0}});
  Numbers predicted({{0.0, 0.1, -1.0}});
  smooth(measured.fixed(), 0.3, predicted.trajectory());
  const Pose2 end = predicted.end();
  REQUIRE(end.x == Approx(0.7));
  REQUIRE(end.y == Approx(0.38));
  REQUIRE(end.yaw == Approx(0.4));
}
