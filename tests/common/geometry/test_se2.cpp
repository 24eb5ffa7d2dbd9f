// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <random>

#include <catch2/catch.hpp>

#include "common/geometry/se2.hpp"

namespace tread {
namespace {

/// Random poses and twists of realistic size, the same in each run.
class Samples {
 public:
  Pose2 pose() { return {within(50.0), within(50.0), within(20.0)}; }
  /// Less than a full turn, so that the logarithm inverts the exponential.
  Twist2 twist() { return {within(3.0), within(3.0), within(6.0)}; }
  Eigen::Vector2d point() { return {within(50.0), within(50.0)}; }

 private:
  double within(double size) {
    return std::uniform_real_distribution<double>(-size, size)(random_);
  }
  std::mt19937_64 random_{17};
};

void checkEqual(const Pose2& a, const Pose2& b, double margin = 1e-10) {
  CHECK(a.x == Approx(b.x).margin(margin));
  CHECK(a.y == Approx(b.y).margin(margin));
  CHECK(a.yaw == Approx(b.yaw).margin(margin));
}

/// The exponential by many small Euler steps: an independent oracle.
Pose2 integrateSlowly(const Twist2& twist, double dt) {
  constexpr int kSteps = 200'000;
  const double step = dt / kSteps;
  Pose2 pose;
  for (int i = 0; i < kSteps; ++i) {
    const double yaw = pose.yaw + twist.omega * step / 2.0;
    pose.x += step * (std::cos(yaw) * twist.v_x - std::sin(yaw) * twist.v_y);
    pose.y += step * (std::sin(yaw) * twist.v_x + std::cos(yaw) * twist.v_y);
    pose.yaw += twist.omega * step;
  }
  return pose;
}

}  // namespace

TEST_CASE("poses form a group: associative, with identity and inverse") {
  Samples samples;
  for (int i = 0; i < 200; ++i) {
    const Pose2 a = samples.pose();
    const Pose2 b = samples.pose();
    const Pose2 c = samples.pose();
    checkEqual((a * b) * c, a * (b * c));
    checkEqual(a * Pose2{}, a);
    checkEqual(Pose2{} * a, a);
    checkEqual(a * inverse(a), Pose2{});
    checkEqual(inverse(a) * a, Pose2{});
    checkEqual(inverse(a * b), inverse(b) * inverse(a));
    checkEqual(a * between(a, b), b);
  }
}

TEST_CASE("a point goes through a product as through its factors") {
  Samples samples;
  for (int i = 0; i < 200; ++i) {
    const Pose2 a = samples.pose();
    const Pose2 b = samples.pose();
    const Eigen::Vector2d p = samples.point();
    CHECK(((a * b) * p).isApprox(a * (b * p), 1e-12));
    CHECK((inverse(a) * (a * p) - p).norm() < 1e-10);
    CHECK((a * Eigen::Vector2d::Zero()).isApprox(a.position()));
  }
}

TEST_CASE("yaw is counter-clockwise: a quarter turn takes forward to left") {
  const Pose2 quarter{0.0, 0.0, kPi / 2.0};
  const Eigen::Vector2d left = quarter * Eigen::Vector2d(1.0, 0.0);
  CHECK(left.x() == Approx(0.0).margin(1e-15));
  CHECK(left.y() == Approx(1.0));
}

TEST_CASE("the exponential is what many small steps give") {
  Samples samples;
  for (int i = 0; i < 10; ++i) {
    const Twist2 twist = samples.twist();
    checkEqual(integrate(twist, 1.3), integrateSlowly(twist, 1.3), 1e-6);
  }
}

TEST_CASE("logarithm and exponential undo each other, up to a full turn") {
  Samples samples;
  for (int i = 0; i < 200; ++i) {
    const Twist2 twist = samples.twist();
    const Twist2 back = twistTo(integrate(twist, 1.0), 1.0);
    CHECK(back.v_x == Approx(twist.v_x).margin(1e-9));
    CHECK(back.v_y == Approx(twist.v_y).margin(1e-9));
    CHECK(back.omega == Approx(twist.omega).margin(1e-12));
  }
  CHECK(twistTo({1.0, 0.0, kPi}, 2.0).omega == Approx(kPi / 2.0));
}

TEST_CASE("exponential and logarithm lose no digits for small turns") {
  for (const double turn : {0.0, 1e-12, 1e-9, 9.9e-7, 1.01e-6, 1e-5, 1e-3}) {
    for (const double sign : {-1.0, 1.0}) {
      const Pose2 end = integrate({1.0, 0.0, sign * turn}, 1.0);
      // Series of (1 - cos t) / t, exact to the last digit at this size.
      const double expected = sign * (turn / 2.0 - turn * turn * turn / 24.0);
      CHECK(end.x == Approx(1.0 - turn * turn / 6.0).epsilon(1e-12));
      CHECK(end.y == Approx(expected).epsilon(1e-11).margin(1e-25));
      const Twist2 back = twistTo(end, 1.0);
      CHECK(back.v_x == Approx(1.0).epsilon(1e-12));
      CHECK(back.v_y == Approx(0.0).margin(1e-12));
    }
  }
}

TEST_CASE("time scales: twice the time is twice the motion") {
  Samples samples;
  for (int i = 0; i < 50; ++i) {
    const Twist2 twist = samples.twist();
    const Pose2 once = integrate(twist, 0.4);
    checkEqual(integrate(twist, 0.8), once * once);
    const Twist2 slow = twistTo(once, 0.8);
    CHECK(slow.v_x == Approx(twist.v_x / 2.0).margin(1e-9));
  }
}

TEST_CASE("yaw is kept over more than a full turn") {
  Pose2 pose;
  const Pose2 step = integrate({1.0, 0.0, 0.5}, 1.0);
  for (int i = 0; i < 20; ++i) pose = pose * step;
  CHECK(pose.yaw == Approx(10.0));
  CHECK(between(Pose2{}, pose).yaw == Approx(10.0));
  CHECK(inverse(pose).yaw == Approx(-10.0));
}

TEST_CASE("angles are wrapped to above -pi up to pi") {
  CHECK(wrapAngle(0.0) == 0.0);
  CHECK(wrapAngle(kPi) == kPi);
  CHECK(wrapAngle(-kPi) == kPi);
  CHECK(wrapAngle(3.0 * kPi / 2.0) == Approx(-kPi / 2.0));
  for (double angle = -50.0; angle < 50.0; angle += 0.01) {
    const double wrapped = wrapAngle(angle);
    CHECK((wrapped > -kPi && wrapped <= kPi));
    CHECK(std::sin(wrapped) == Approx(std::sin(angle)).margin(1e-12));
    CHECK(std::cos(wrapped) == Approx(std::cos(angle)).margin(1e-12));
  }
}

}  // namespace tread
