// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// What one surface knows from what was measured on it, against the equations with dense matrices.
#include <catch2/catch.hpp>

#include <map>

#include <Eigen/LU>

#include "tests/helpers.hpp"
#include "tests/learner/drawn_ground.hpp"

using namespace tread;
using namespace tread::learner;
using namespace tread::learner::samples;
using tread::testing::effort;

namespace {

/// h of a part of a pattern, for the whole state of a velocity.
Eigen::VectorXd dense(const GroundModel& model, const PatternPart& part, size_t velocity) {
  Eigen::VectorXd h = Eigen::VectorXd::Zero(model.dimension());
  for (Eigen::Index i = 0; i < kTerms; ++i) h[i] = part.common[velocity][static_cast<size_t>(i)];
  h[kTerms + static_cast<Eigen::Index>(part.pattern)] = part.own[velocity];
  return h;
}

struct Fixture {
  explicit Fixture(const GroundConfig& changed = {}) : config(changed) {
    prior.residual = 0.7;
    for (size_t term = 0; term < config.common.size(); ++term)
      prior.common.data()[term] = 0.5 * config.common[term] * config.common[term];
    prior.scatter = Eigen::Matrix3Xd::Ones(3, static_cast<Eigen::Index>(world.patterns()));
    prior.scatter.col(kHardLeft) << 2.0, 0.5, 3.0;
    for (size_t velocity = 0; velocity < kVelocities; ++velocity)
      prior.centre[velocity] = Eigen::VectorXd::Constant(world.model().dimension(), 0.02);
  }
  const GroundModel& model() const { return world.model(); }
  /// R of a velocity.
  double R(const PatternPart& part, Eigen::Index axis) const {
    return part.noise[axis] * prior.scatter(axis, static_cast<Eigen::Index>(part.pattern));
  }
  Surface surface() const { return {world.model(), config, prior}; }
  /// An execution on a ground that is the shipped one, with a variance over the expected one.
  TwistSample sample(size_t pattern, double noise, std::mt19937_64& random) const {
    return part(world.model().whole(pattern), noise, random);
  }
  static TwistSample part(const PatternPart& part, double noise, std::mt19937_64& random) {
    TwistSample sample{part, part.mean};
    for (Eigen::Index axis = 0; axis < 3; ++axis)
      sample.mean_twist[axis] += std::sqrt(noise * part.noise[axis]) * chanceOf(random);
    return sample;
  }

  GroundConfig config;
  SurfacePrior prior;
  DrawnWorld world;
};

/// Of patterns that scatter as the model expects.
Fixture evenly() {
  Fixture fixture;
  fixture.prior.scatter.setOnes();
  return fixture;
}

double logStudent(double y, double scale2, double freedom) {
  return std::lgamma(0.5 * (freedom + 1.0)) - std::lgamma(0.5 * freedom) -
         0.5 * std::log(freedom * kPi * scale2) -
         0.5 * (freedom + 1.0) * std::log(1.0 + y * y / (freedom * scale2));
}

}  // namespace

TEST_CASE("a surface is the regression of all that was measured on it, of parts as well") {
  const Fixture f;
  Surface surface = f.surface();
  std::mt19937_64 random(1);
  std::vector<TwistSample> samples;
  for (int i = 0; i < 60; ++i) {
    const size_t p = random() % f.model().patterns();
    const bool whole = i % 3 != 0;
    samples.push_back(whole ? f.sample(p, 1.5, random)
                            : f.part(f.model().part(p, 5 + i % 2), 0.7, random));
    const Eigen::Vector3d q_before = surface.noise();
    surface.add(f.model(), f.config, samples.back());
    const TwistSample next = f.sample(random() % f.model().patterns(), 9.0, random);
    double log_density = 0.0;
    for (size_t velocity = 0; velocity < kVelocities; ++velocity) {
      const auto axis = static_cast<Eigen::Index>(velocity);
      Eigen::MatrixXd Q = f.prior.residual * f.model().spread(velocity);
      Q.topLeftCorner<kTerms, kTerms>() = f.prior.common.col(axis).asDiagonal();
      Eigen::MatrixXd information = Q.inverse();
      Eigen::VectorXd sum = Eigen::VectorXd::Zero(information.rows());
      for (const TwistSample& each : samples) {
        const Eigen::VectorXd h = dense(f.model(), each.part, velocity);
        const double R = q_before[axis] * f.R(each.part, axis);
        const double z = each.mean_twist[axis] - each.part.mean[axis];
        information += h * h.transpose() / R;
        sum += h * (z - h.dot(f.prior.centre[velocity])) / R;
      }
      const Eigen::MatrixXd P = information.inverse();
      const Eigen::VectorXd x = f.prior.centre[velocity] + P * sum;
      REQUIRE((surface.mean()[velocity] - x).cwiseAbs().maxCoeff() < 1e-10);
      REQUIRE((surface.covariance()[velocity] - P).cwiseAbs().maxCoeff() < 1e-12);
      double a = 0.5 * f.config.noise_prior;
      double b = a;
      for (const TwistSample& each : samples) {
        const Eigen::VectorXd h = dense(f.model(), each.part, velocity);
        const double y = each.mean_twist[axis] - each.part.mean[axis] - h.dot(x);
        a += 0.5;
        b += 0.5 * (y * y + h.dot(P * h)) / f.R(each.part, axis);
      }
      REQUIRE(surface.noise()[axis] == Approx(b / a));
      // The density of a next execution.
      const Eigen::VectorXd h = dense(f.model(), next.part, velocity);
      const double y = next.mean_twist[axis] - next.part.mean[axis] - h.dot(x);
      const double freedom = std::min(2.0 * a, f.config.most_freedom);
      log_density += logStudent(y, h.dot(P * h) + b / a * f.R(next.part, axis), freedom);
      // And its variance.
      REQUIRE(surface.executionNoise(next.part)[axis] ==
              Approx(b / a * f.R(next.part, axis) * freedom / (freedom - 2.0)));
    }
    REQUIRE(surface.logDensity(next) == Approx(log_density).margin(1e-9));
    REQUIRE(surface.executions() == i + 1.0);
  }
}

TEST_CASE("the order in which the same was measured does not matter but for the noise's step") {
  const Fixture f;
  std::mt19937_64 random(2);
  std::vector<TwistSample> samples;
  for (int i = 0; i < 40; ++i) samples.push_back(f.sample(random() % 7, 1.0, random));
  Surface forwards = f.surface();
  Surface backwards = f.surface();
  for (const TwistSample& sample : samples) forwards.add(f.model(), f.config, sample);
  std::reverse(samples.begin(), samples.end());
  for (const TwistSample& sample : samples) backwards.add(f.model(), f.config, sample);
  for (size_t velocity = 0; velocity < kVelocities; ++velocity)
    REQUIRE((forwards.mean()[velocity] - backwards.mean()[velocity]).cwiseAbs().maxCoeff() < 2e-3);
  REQUIRE((forwards.noise() - backwards.noise()).cwiseAbs().maxCoeff() < 0.02);
}

TEST_CASE("a surface learns its own noise, calm or rough, each velocity for itself") {
  const Fixture f = evenly();
  for (const double factor : {0.25, 1.0, 4.0, 12.0}) {
    INFO("variance " << factor << " times the expected one");
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();
    const int seeds = 40;
    for (int seed = 1; seed <= seeds; ++seed) {
      std::mt19937_64 random(static_cast<uint64_t>(seed));
      Surface surface = f.surface();
      for (int i = 0; i < 100; ++i) {
        TwistSample sample = f.sample(random() % 7, factor, random);
        sample.mean_twist[1] =
            sample.part.mean[1] + std::sqrt(sample.part.noise[1]) * chanceOf(random);
        surface.add(f.model(), f.config, sample);
      }
      mean += surface.noise() / seeds;
    }
    // 100 executions against the 5 that the expected noise counts for.
    const double expected = (100.0 * factor + 5.0) / 105.0;
    REQUIRE(mean[0] == Approx(expected).epsilon(0.15));
    REQUIRE(mean[2] == Approx(expected).epsilon(0.15));
    REQUIRE(mean[1] == Approx(1.0).epsilon(0.15));
  }
}

TEST_CASE("executions beyond the longest memory fade, so that a surface may change slowly") {
  GroundConfig config;
  config.longest_memory = 20.0;
  const Fixture f(config);
  Surface surface = f.surface();
  TwistSample sample{f.model().whole(kAhead), f.model().whole(kAhead).mean};
  for (int i = 0; i < 500; ++i) surface.add(f.model(), f.config, sample);
  REQUIRE(surface.executions() == 20.0);
  sample.mean_twist[0] *= 1.1;
  for (int i = 0; i < 60; ++i) surface.add(f.model(), f.config, sample);
  REQUIRE(surface.executions() == 20.0);
  // 20 of 20 fade by 20/21 each: .95 of what it was told.
  REQUIRE(response(sample.part, 0, surface.mean()[0]) == Approx(0.1).epsilon(0.15));
}

TEST_CASE("a surface stays symmetric, positive definite and finite, absurd or not") {
  const Fixture f;
  for (const double scale : {0.05, 3.0, 1e5}) {
    INFO(scale);
    Surface surface = f.surface();
    std::mt19937_64 random(6);
    for (int i = 0; i < effort(3000); ++i) {
      const size_t p = random() % f.model().patterns();
      TwistSample sample{f.model().whole(p), f.model().whole(p).mean};
      for (double& number : sample.mean_twist)
        number += (i % 5 == 0 ? scale : 0.05) * chanceOf(random);
      sample.mean_twist = plausible(sample.mean_twist);
      surface.add(f.model(), f.config, sample);
      if (i % 50 != 0) continue;
      for (size_t velocity = 0; velocity < kVelocities; ++velocity) {
        const Eigen::MatrixXd& P = surface.covariance()[velocity];
        REQUIRE(P == P.transpose());
        REQUIRE(P.llt().info() == Eigen::Success);
        REQUIRE(surface.mean()[velocity].allFinite());
      }
      REQUIRE(std::isfinite(surface.logDensity(sample)));
      REQUIRE(surface.noise().minCoeff() >= 0.05);
      REQUIRE(surface.noise().maxCoeff() <= kMostNoise);
    }
  }
}

TEST_CASE("no measured twist counts as more than a vehicle can drive") {
  REQUIRE(plausible({1e300, -1e300, 99.0}) == Eigen::Vector3d(100.0, -100.0, 99.0));
}
