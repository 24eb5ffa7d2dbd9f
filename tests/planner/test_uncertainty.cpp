// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <Eigen/Cholesky>
#include <Eigen/Geometry>
#include <limits>
#include <random>

#include "modules/planner/core/search/pattern_table.hpp"
#include "tests/helpers.hpp"

using namespace tread;
using namespace tread::planner;

namespace {

using Matrix = Eigen::Matrix3d;
using Vector = Eigen::Vector3d;

Matrix matrixOf(const Uncertainty& u) {
  Matrix m;
  m << static_cast<double>(u.xx), static_cast<double>(u.xy), static_cast<double>(u.xyaw),
      static_cast<double>(u.xy), static_cast<double>(u.yy), static_cast<double>(u.yyaw),
      static_cast<double>(u.xyaw), static_cast<double>(u.yyaw), static_cast<double>(u.yawyaw);
  return m;
}

/// Largest variance over many directions.
double greatestVariance(const Eigen::Matrix2d& m) {
  double greatest = 0.0;
  for (int i = 0; i < 3600; ++i) {
    const double angle = kPi * i / 3600.0;
    const Eigen::Vector2d direction(std::cos(angle), std::sin(angle));
    greatest = std::max(greatest, direction.dot(m * direction));
  }
  return greatest;
}

Uncertainty fromMatrix(const Matrix& m) {
  const auto at = [&m](int row, int column) { return static_cast<float>(m(row, column)); };
  return {at(0, 0), at(0, 1), at(0, 2), at(1, 1), at(1, 2), at(2, 2)};
}

/// A covariance with random correlations and standard deviations of about `sigma`.
Uncertainty randomUncertainty(std::mt19937_64& random, double sigma) {
  std::normal_distribution<double> draw(0.0, sigma);
  Matrix root;
  for (int i = 0; i < 9; ++i) root(i / 3, i % 3) = draw(random);
  return fromMatrix(root * root.transpose());
}

Pose2 randomPose(std::mt19937_64& random, double reach) {
  std::uniform_real_distribution<double> draw(-1.0, 1.0);
  return {reach * draw(random), reach * draw(random), kPi * draw(random)};
}

Uncertainty composed(const Uncertainty& at, const Uncertainty& step, const Pose2& T_map_b,
                     const Pose2& T_b_c) {
  const Pose2 T_map_c = T_map_b * T_b_c;
  return compose(at, step, static_cast<float>(T_map_c.x - T_map_b.x),
                 static_cast<float>(T_map_c.y - T_map_b.y),
                 static_cast<float>(std::cos(T_map_b.yaw)),
                 static_cast<float>(std::sin(T_map_b.yaw)));
}

Vector vectorOf(const Pose2& pose) {
  return {pose.x, pose.y, pose.yaw};
}

Pose2 moved(const Pose2& pose, const Vector& by) {
  return {pose.x + by.x(), pose.y + by.y(), pose.yaw + by.z()};
}

/// Derivatives of T_map_b * T_b_c with respect to the first or the second.
Matrix jacobian(const Pose2& first, const Pose2& second, bool of_first) {
  constexpr double kStep = 1e-6;
  Matrix result;
  for (int i = 0; i < 3; ++i) {
    const Vector by = kStep * Vector::Unit(i);
    const Pose2 up = of_first ? moved(first, by) * second : first * moved(second, by);
    const Pose2 down = of_first ? moved(first, -by) * second : first * moved(second, -by);
    result.col(i) = (vectorOf(up) - vectorOf(down)) / (2.0 * kStep);
  }
  return result;
}

void requireAlike(const Matrix& a, const Matrix& b, double share) {
  // Entries in metres and radians have similar sizes here.
  INFO(a << "\n-- against --\n" << b);
  REQUIRE((a - b).norm() <= share * b.norm());
}

}  // namespace

TEST_CASE("a composed covariance is that of numeric Jacobians, wherever the poses lie") {
  std::mt19937_64 random(1);
  for (int i = 0; i < testing::effort(2000); ++i) {
    const Uncertainty at = randomUncertainty(random, 0.2);
    const Uncertainty step = randomUncertainty(random, 0.2);
    const Pose2 T_map_b = randomPose(random, 5.0);
    const Pose2 T_b_c = randomPose(random, 2.0);
    const Matrix f = jacobian(T_map_b, T_b_c, true);
    const Matrix g = jacobian(T_map_b, T_b_c, false);
    const Matrix expected = f * matrixOf(at) * f.transpose() + g * matrixOf(step) * g.transpose();
    requireAlike(matrixOf(composed(at, step, T_map_b, T_b_c)), expected, 1e-4);
  }
}

TEST_CASE("a composed covariance is what a sample of disturbed poses scatters by") {
  std::mt19937_64 random(2);
  std::normal_distribution<double> normal;
  for (int i = 0; i < testing::effort(20); ++i) {
    const Uncertainty at = randomUncertainty(random, 0.02);
    const Uncertainty step = randomUncertainty(random, 0.02);
    const Pose2 T_map_b = randomPose(random, 3.0);
    const Pose2 T_b_c = randomPose(random, 1.5);
    const Matrix root_at = matrixOf(at).llt().matrixL();
    const Matrix root_step = matrixOf(step).llt().matrixL();
    const auto disturbed = [&](const Pose2& pose, const Matrix& root) {
      return moved(pose, root * Vector(normal(random), normal(random), normal(random)));
    };
    constexpr int kCount = 20'000;
    Vector sum = Vector::Zero();
    Matrix squares = Matrix::Zero();
    const Vector expected_mean = vectorOf(T_map_b * T_b_c);
    for (int k = 0; k < kCount; ++k) {
      const Vector off =
          vectorOf(disturbed(T_map_b, root_at) * disturbed(T_b_c, root_step)) - expected_mean;
      sum += off;
      squares += off * off.transpose();
    }
    const Vector mean = sum / kCount;
    const Matrix sampled = squares / kCount - mean * mean.transpose();
    // A sample of that size is off by about 1 %; the neglected part is of second order.
    requireAlike(matrixOf(composed(at, step, T_map_b, T_b_c)), sampled, 0.05);
  }
}

TEST_CASE("what is certain stays certain, and a long chain gathers what each link adds") {
  const Uncertainty sure = composed({}, {}, {3.0, -1.0, 2.0}, {1.0, 0.5, -0.4});
  CHECK(matrixOf(sure).isZero());
  Uncertainty along;
  Uncertainty step;
  step.yawyaw = 1e-4F;
  Pose2 pose;
  for (int i = 0; i < 100; ++i) {
    along = composed(along, step, pose, {1.0, 0.0, 0.0});
    pose = pose * Pose2{1.0, 0.0, 0.0};
  }
  // Straight ahead each of the 100 turn errors moves the end sideways by the remaining path.
  double sideways = 0.0;
  for (int i = 0; i < 100; ++i) sideways += 1e-4 * i * i;
  CHECK(static_cast<double>(along.yawyaw) == Approx(0.01).epsilon(1e-4));
  CHECK(static_cast<double>(along.yy) == Approx(sideways).epsilon(1e-4));
  CHECK(static_cast<double>(along.xx) == Approx(0.0).margin(1e-9));
}

TEST_CASE("a share of a covariance is that share, turned into the other axes and back") {
  std::mt19937_64 random(3);
  std::uniform_real_distribution<double> angle(-7.0, 7.0);
  for (int i = 0; i < testing::effort(500); ++i) {
    const Uncertainty u = randomUncertainty(random, 0.3);
    const double yaw = angle(random);
    Matrix turn = Matrix::Identity();
    turn.topLeftCorner<2, 2>() = Eigen::Rotation2Dd(yaw).toRotationMatrix();
    const Uncertainty part = scaled(u, 0.37, yaw);
    requireAlike(matrixOf(part), 0.37 * turn * matrixOf(u) * turn.transpose(), 1e-5);
    requireAlike(matrixOf(scaled(part, 1.0 / 0.37, -yaw)), matrixOf(u), 1e-5);
    CHECK(matrixOf(scaled(u, 0.0, yaw)).isZero());
  }
}

TEST_CASE("the variance of the position is the larger one, however the axes lie") {
  std::mt19937_64 random(4);
  for (int i = 0; i < testing::effort(500); ++i) {
    const Uncertainty u = randomUncertainty(random, 0.3);
    const Eigen::Matrix2d block = matrixOf(u).topLeftCorner<2, 2>();
    const double largest = greatestVariance(block);
    CHECK(static_cast<double>(u.position()) == Approx(largest).epsilon(1e-4));
  }
}

TEST_CASE("no point at the end of an arm scatters more than is said, and some scatter so much") {
  std::mt19937_64 random(5);
  std::uniform_real_distribution<double> angle(-kPi, kPi);
  std::uniform_real_distribution<double> length(0.0, 2.0);
  for (int i = 0; i < testing::effort(5000); ++i) {
    const Uncertainty u = randomUncertainty(random, 0.3);
    const double towards = angle(random);
    const double arm = length(random);
    Eigen::Matrix<double, 2, 3> moves;  // of the point, with respect to x, y and yaw
    moves << 1.0, 0.0, -arm * std::sin(towards), 0.0, 1.0, arm * std::cos(towards);
    const Eigen::Matrix2d scatter = moves * matrixOf(u) * moves.transpose();
    const double worst = greatestVariance(scatter);
    REQUIRE(worst <= static_cast<double>(u.ofPoint(static_cast<float>(arm))) * (1.0 + 1e-5));
  }
  // Correlated sideways error and turn: a point ahead moves by the sum of both.
  Uncertainty together;
  together.yy = 0.04F;
  together.yawyaw = 0.01F;
  together.yyaw = 0.02F;
  CHECK(static_cast<double>(together.ofPoint(2.0F)) == Approx(0.16));
}

TEST_CASE("a covariance with an unknown number is replaced, a negative variance counts as none") {
  Uncertainty otherwise;
  otherwise.yy = 7.0F;
  PoseCovariance values{1.0, 0.1, 0.2, 2.0, 0.3, 3.0};
  const Uncertainty known = uncertaintyOf(values, otherwise);
  Matrix expected;
  expected << 1.0, 0.1, 0.2, 0.1, 2.0, 0.3, 0.2, 0.3, 3.0;
  requireAlike(matrixOf(known), expected, 1e-6);
  for (double& value : values) {
    const double kept = value;
    value = std::numeric_limits<double>::quiet_NaN();
    CHECK(uncertaintyOf(values, otherwise).yy == 7.0F);
    value = std::numeric_limits<double>::infinity();
    CHECK(uncertaintyOf(values, otherwise).yy == 7.0F);
    value = kept;
  }
  values[0] = -1e-9;
  CHECK(uncertaintyOf(values, otherwise).xx == 0.0F);
}
