// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Patterns as body twists, their parts, and what is expected of grounds before anything is
// measured.
#include <catch2/catch.hpp>

#include <Eigen/Cholesky>

#include "tests/learner/drawn_ground.hpp"

using namespace tread;
using namespace tread::learner;
using namespace tread::learner::samples;

namespace {

/// Mean twist of the first samples under a correction.
Eigen::Vector3d meanUnder(const TwistProfile& profile, const CorrectionVector& correction,
                          Eigen::Index samples) {
  std::vector<double> numbers(static_cast<size_t>(3 * profile.samples()));
  Trajectory all(numbers.data(), profile.samples(), 3);
  profile.integrate(correction, all);
  const Eigen::Array<double, Eigen::Dynamic, 3> beginning = all.topRows(samples);
  return meanTwist(ConstTrajectory(beginning.data(), samples, 3), samples, 0.05);
}

}  // namespace

TEST_CASE("a twist profile without a correction is the shipped prediction") {
  const PatternSet set = windingSet();
  for (const MotionPattern& pattern : set.patterns()) {
    const TwistProfile profile(pattern, 0.05);
    std::vector<double> numbers(3 * pattern.trajectory.size());
    const auto samples = static_cast<Eigen::Index>(pattern.trajectory.size());
    profile.integrate(CorrectionVector::Zero(), Trajectory(numbers.data(), samples, 3));
    const std::vector<Pose2> poses = posesOf(ConstTrajectory(numbers.data(), samples, 3));
    for (size_t t = 0; t < poses.size(); ++t) {
      REQUIRE(distance(poses[t], pattern.trajectory[t]) < 1e-12);
      REQUIRE(poses[t].yaw == Approx(pattern.trajectory[t].yaw).margin(1e-12));
    }
    REQUIRE(distance(profile.integrateEnd(CorrectionVector::Zero()), poses.back()) < 1e-12);
  }
}

TEST_CASE("a twist profile responds to its corrections as its derivatives say") {
  const PatternSet set = windingSet();
  for (const MotionPattern& pattern : set.patterns()) {
    const TwistProfile profile(pattern, 0.05);
    for (int i = 0; i < TwistCorrection::kAll; ++i) {
      INFO(pattern.name << ", correction " << i);
      constexpr double kStep = 1e-5;
      CorrectionVector step = CorrectionVector::Zero();
      step[i] = kStep;
      const Pose2 up = profile.integrateEnd(step);
      const Pose2 down = profile.integrateEnd(-step);
      // To first order in the turn of one sample.
      const auto column = profile.endResponse().col(i);
      REQUIRE(column[0] == Approx((up.x - down.x) / (2.0 * kStep)).margin(3e-4));
      REQUIRE(column[1] == Approx((up.y - down.y) / (2.0 * kStep)).margin(3e-4));
      REQUIRE(column[2] == Approx((up.yaw - down.yaw) / (2.0 * kStep)).margin(3e-4));
    }
  }
}

TEST_CASE("the mean twist of any part of a pattern is corrected exactly, also far from zero") {
  const PatternSet set = windingSet();
  const GroundModel model(GroundConfig{}, set);
  for (size_t p = 0; p < model.patterns(); ++p) {
    const TwistProfile& profile = model.profile(p);
    for (Eigen::Index samples = 1; samples <= profile.samples(); samples += 6) {
      const PatternPart part = model.part(p, samples);
      REQUIRE(part.samples == samples);
      REQUIRE((part.mean - meanUnder(profile, CorrectionVector::Zero(), samples)).norm() < 1e-12);
      for (size_t velocity = 0; velocity < kVelocities; ++velocity) {
        INFO(set.patterns()[p].name << ", samples " << samples << ", velocity " << velocity);
        const Eigen::Index own = kTerms + static_cast<Eigen::Index>(p);
        for (Eigen::Index i = 0; i <= kTerms; ++i) {
          CorrectionVector step = CorrectionVector::Zero();
          Eigen::VectorXd x = Eigen::VectorXd::Zero(model.dimension());
          x[i < kTerms ? i : own] = 0.3;
          step[i < kTerms ? kTerms * static_cast<Eigen::Index>(velocity) + i
                          : TwistCorrection::kCommon + static_cast<Eigen::Index>(velocity)] = 0.3;
          Eigen::Vector3d expected = part.mean;
          expected[static_cast<Eigen::Index>(velocity)] += response(part, velocity, x);
          REQUIRE((meanUnder(profile, step, samples) - expected).norm() < 1e-12);
        }
      }
    }
  }
}

TEST_CASE("the noise of a part grows with its shortness, the whole is its longest part") {
  const GroundModel model(GroundConfig{}, windingSet());
  for (size_t p = 0; p < model.patterns(); ++p) {
    const PatternPart& whole = model.whole(p);
    REQUIRE(whole.samples == model.profile(p).samples());
    double metres = 0.0;
    for (Eigen::Index samples = 1; samples <= whole.samples; ++samples) {
      const PatternPart part = model.part(p, samples);
      REQUIRE(part.metres >= metres);
      metres = part.metres;
      REQUIRE(part.noise.minCoeff() > 0.0);
      // A hundredth of a metre of a measured end is a lot in a short time.
      const double seconds = 0.05 * static_cast<double>(samples);
      REQUIRE(part.noise[0] >= 1e-4 / (seconds * seconds));
      if (samples == 1) REQUIRE(part.noise[0] > 10.0 * whole.noise[0]);
    }
    REQUIRE(metres == Approx(whole.metres));
    REQUIRE(model.part(p, whole.samples).noise == whole.noise);
  }
}

TEST_CASE("noise of an execution is as configured, and partly as recorded where that is known") {
  PatternSetContent content = richContent();
  content.patterns[kAhead].end_covariance = {0.01, 0.0, 0.0, 0.01, 0.0, 0.01};
  GroundConfig config;
  const GroundModel plain(config, richSet());
  const auto at = [](double share, double of, double seconds) {
    return share * share + of * of / (seconds * seconds);
  };
  const Eigen::Vector3d ahead = plain.whole(kAhead).noise;
  REQUIRE(ahead[0] == Approx(at(0.03, 0.01, 1.0)));
  REQUIRE(ahead[1] == Approx(at(0.03, 0.01, 1.0)));
  REQUIRE(ahead[2] == Approx(at(0.005, 0.01, 1.0)));
  REQUIRE(plain.whole(kTurning).noise[0] == Approx(at(0.05 * 1.2, 0.01, 1.0)));
  REQUIRE(plain.whole(kTurning).noise[2] == Approx(at(0.08 * 1.2, 0.01, 1.0)));
  // 0.1 m in a second of driving straight.
  const GroundModel recorded(config, checked(content));
  REQUIRE(recorded.whole(kAhead).noise[0] == Approx(0.7 * ahead[0] + 0.3 * 0.01));
  REQUIRE(recorded.whole(kTurnLeft).noise == plain.whole(kTurnLeft).noise);
  config.recorded = 0.0;
  REQUIRE(GroundModel(config, checked(content)).whole(kAhead).noise == ahead);
}

TEST_CASE("a recorded spread of nothing makes no execution exact") {
  PatternSetContent content = richContent();
  // As recorded where a simulator never turned.
  for (MotionPattern& pattern : content.patterns)
    pattern.end_covariance = {7e-4, 0.0, 0.0, 1e-3, 0.0, 0.0};
  RuleConfig config = ruleConfig("multi_model");
  config.ground.recorded = 1.0;
  const GroundModel model(config.ground, checked(content));
  for (size_t p = 0; p < model.patterns(); ++p) REQUIRE(model.whole(p).noise.minCoeff() > 0.0);
  Pupil pupil(config, checked(content));
  for (int i = 0; i < 20; ++i)
    for (size_t p = 0; p < pupil.patterns(); ++p)
      pupil.learn(p, under({1.1, i % 2 == 0 ? 1.0 : 1.1, 0.0, 0.0}, pupil.shipped(p)));
  for (const double number : pupil.everything()) REQUIRE(std::isfinite(number));
  for (const double number : pupil.rule().memory()) REQUIRE(std::isfinite(number));
}

TEST_CASE("the spread of grounds is a covariance, with neighbours and mirror images alike") {
  const GroundConfig config;
  const GroundModel model(config, windingSet());
  for (size_t velocity = 0; velocity < kVelocities; ++velocity) {
    const Eigen::MatrixXd& Q = model.spread(velocity);
    REQUIRE(Q == Q.transpose());
    REQUIRE(Q.llt().info() == Eigen::Success);
    for (Eigen::Index i = 0; i < kTerms; ++i)
      REQUIRE(std::sqrt(Q(i, i)) == Approx(config.common[3 * velocity + static_cast<size_t>(i)]));
    const auto own = [&](size_t p, size_t q) {
      return Q(kTerms + static_cast<Eigen::Index>(p), kTerms + static_cast<Eigen::Index>(q));
    };
    REQUIRE(std::sqrt(own(kHardLeft, kHardLeft)) == Approx(config.residual[velocity]));
    // What slips to one side in a left turn slips to the other in a right one.
    const double mirrored = own(kHardLeft, kHardRight) / own(kHardLeft, kHardLeft);
    if (velocity == 1) REQUIRE(mirrored < -0.5);
    if (velocity != 1) REQUIRE(mirrored == Approx(0.7).margin(0.03));
    REQUIRE(own(kTurnLeft, kHardLeft) > own(kTurnLeft, kBack));
  }
}

TEST_CASE("whatever the corrections are, a predicted pattern stays one that can be driven") {
  const PatternSet set = windingSet();
  std::mt19937_64 random(9);
  for (int i = 0; i < 2000; ++i) {
    CorrectionVector correction;
    for (int k = 0; k < TwistCorrection::kAll; ++k)
      correction[k] = chanceOf(random) * std::pow(10.0, 4.0 * chanceOf(random));
    for (const MotionPattern& pattern : set.patterns()) {
      const TwistProfile profile(pattern, 0.05);
      const Pose2 end = profile.integrateEnd(correction);
      const double seconds = 0.05 * static_cast<double>(profile.samples());
      const Eigen::Vector2d speed = profile.meanSpeed(profile.samples());
      REQUIRE(std::hypot(end.x, end.y) <= (5.1 * speed[0] + 1.0 * speed[1]) * seconds + 1e-9);
      REQUIRE(std::abs(end.yaw) <= (3.0 * speed[1] + 0.5 * speed[0]) * seconds + 1e-9);
    }
  }
}
