// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <cmath>
#include <limits>
#include <random>

#include <Eigen/LU>

#include "common/ground/shock_model.hpp"

using namespace tread;

namespace {

/// A synthetic vehicle and ground: shock = 1.5 (r / 1 cm)^1.3 v^1.6, with scatter.
ShockRegression taught(int pairs, double scatter, uint64_t seed = 1) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  ShockRegression regression;
  for (int i = 0; i < pairs; ++i) {
    const double roughness = 0.004 + 0.002 * (i % 9);
    const double speed = 0.4 + 0.2 * (i % 5);
    const double mean = 1.5 * std::pow(roughness / 0.01, 1.3) * std::pow(speed, 1.6);
    regression.learn(roughness, speed, mean * std::exp(scatter * normal(random)));
  }
  return regression;
}

}  // namespace

TEST_CASE("without experience the shock model is its prior") {
  const ShockModel prior, model = ShockRegression().model();
  CHECK((model.mean - prior.mean).norm() < 1e-9);
  CHECK((model.covariance - prior.covariance).norm() < 1e-9);
  CHECK(model.variance == Approx(prior.variance));
}

TEST_CASE("the regression finds the vehicle's own law, and how much it scatters") {
  const ShockModel model = taught(600, 0.3).model();
  CHECK(model.mean[0] == Approx(std::log(1.5)).margin(0.1));
  CHECK(model.mean[1] == Approx(1.3).margin(0.12));
  CHECK(model.mean[2] == Approx(1.6).margin(0.15));
  CHECK(std::sqrt(model.variance) == Approx(0.3).margin(0.04));
}

TEST_CASE("its intervals hold what they promise") {
  int inside = 0;
  const Eigen::Vector3d truth(std::log(1.5), 1.3, 1.6);
  constexpr int kRuns = 200;
  for (uint64_t seed = 1; seed <= kRuns; ++seed) {
    const ShockModel model = taught(60, 0.4, seed).model();
    const Eigen::Vector3d off = model.mean - truth;
    // 7.81 is the 95 % quantile of chi-square with three degrees of freedom.
    if (off.dot(model.covariance.inverse() * off) < 7.81) ++inside;
  }
  CHECK(inside > 0.88 * kRuns);
}

TEST_CASE("what is uncertain costs more, and experience makes it cheaper") {
  ShockModel sure;
  sure.covariance.setZero();
  const ShockModel unsure;
  CHECK(unsure.meanSquare(0.02, 1.0) > 1.5 * sure.meanSquare(0.02, 1.0));
  CHECK(unsure.meanSquare(0.02, 1.0) > unsure.meanSquare(0.01, 1.0));
  CHECK(unsure.meanSquare(0.02, 1.0) > unsure.meanSquare(0.02, 0.5));
  // Ground that was driven on: only the change of speed is extrapolated.
  CHECK(unsure.meanSquareLike(0.5, 1.0) == Approx(0.25 * std::exp(0.5)));
  CHECK(unsure.meanSquareLike(0.5, 0.5) < 0.25 * unsure.meanSquareLike(0.5, 1.0));
}

TEST_CASE("a new payload is learned over the old one") {
  ShockRegression regression = taught(3000, 0.2);
  for (int i = 0; i < 3000; ++i) {
    const double roughness = 0.004 + 0.002 * (i % 9), speed = 0.4 + 0.2 * (i % 5);
    regression.learn(roughness, speed,
                     3.0 * std::pow(roughness / 0.01, 1.3) * std::pow(speed, 1.6));
  }
  CHECK(regression.model().mean[0] == Approx(std::log(3.0)).margin(0.1));
}

TEST_CASE("what was learned can be kept, and what is no state is refused") {
  const ShockRegression before = taught(50, 0.3);
  const auto after = ShockRegression::fromState(before.state());
  REQUIRE(after);
  CHECK(after->pairs() == 50);
  CHECK(after->model().mean == before.model().mean);
  CHECK(after->model().covariance == before.model().covariance);
  std::vector<double> numbers = before.state();
  numbers[3] = std::numeric_limits<double>::quiet_NaN();
  CHECK_FALSE(ShockRegression::fromState(numbers));
  numbers[3] = -1.0;
  CHECK_FALSE(ShockRegression::fromState(numbers));
  numbers.pop_back();
  CHECK_FALSE(ShockRegression::fromState(numbers));
  CHECK_FALSE(ShockRegression::fromState({}));
}

TEST_CASE("pairs that cannot be are ignored") {
  constexpr double kNan = std::numeric_limits<double>::quiet_NaN();
  ShockRegression regression;
  for (const double bad : {0.0, -1.0, kNan, std::numeric_limits<double>::infinity()}) {
    regression.learn(bad, 1.0, 1.0);
    regression.learn(0.01, bad, 1.0);
    regression.learn(0.01, 1.0, bad);
  }
  CHECK(regression.pairs() == 0);
  CHECK((regression.model().mean - ShockModel().mean).norm() < 1e-9);
}
