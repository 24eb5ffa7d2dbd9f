// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Patterns as body twists, their parts, and the prior of grounds before any measurement.
#include <catch2/catch.hpp>

#include <Eigen/Cholesky>

#include "tests/learner/drawn_ground.hpp"

using namespace tread;
using namespace tread::learner;
using namespace tread::learner::samples;

namespace {

/// Mean twist of some samples with a correction.
Eigen::Vector3d meanUnder(const GroundModel& model, size_t pattern,
                          const TwistCorrection& correction, Eigen::Index first,
                          Eigen::Index samples) {
  const TwistProfile& profile = model.profile(pattern);
  std::vector<double> numbers(static_cast<size_t>(3 * profile.samples()));
  Trajectory all(numbers.data(), profile.samples(), 3);
  profile.integrate(model.scale(), correction, all);
  const ConstTrajectory measured(numbers.data(), profile.samples(), 3);
  return meanTwist(measured, first, samples, 0.05);
}

/// One of all corrections, the common ones first.
TwistCorrection only(int which, double value) {
  TwistCorrection correction;
  if (which < TwistCorrection::kCommon)
    correction.common[which] = value;
  else
    correction.own[which - TwistCorrection::kCommon] = value;
  return correction;
}

}  // namespace

TEST_CASE("a twist profile without a correction is the shipped prediction") {
  const PatternSet set = windingSet();
  const GroundModel model(GroundConfig{}, set);
  for (size_t p = 0; p < model.patterns(); ++p) {
    const std::vector<Pose2>& shipped = set.patterns()[p].trajectory;
    std::vector<double> numbers(3 * shipped.size());
    const auto samples = static_cast<Eigen::Index>(shipped.size());
    model.profile(p).integrate(model.scale(), {}, Trajectory(numbers.data(), samples, 3));
    const std::vector<Pose2> poses = posesOf(ConstTrajectory(numbers.data(), samples, 3));
    for (size_t t = 0; t < poses.size(); ++t) {
      REQUIRE(distance(poses[t], shipped[t]) < 1e-12);
      REQUIRE(poses[t].yaw == Approx(shipped[t].yaw).margin(1e-12));
    }
    REQUIRE(distance(model.profile(p).integrateEnd(model.scale(), {}), poses.back()) < 1e-12);
  }
}

TEST_CASE("the mean twist of any part of a pattern is corrected exactly, also far from zero") {
  const PatternSet set = windingSet();
  const GroundModel model(GroundConfig{}, set);
  for (size_t p = 0; p < model.patterns(); ++p)
    for (Eigen::Index end = 1; end <= model.profile(p).samples(); end += 6) {
      const Eigen::Index first = (end % 4) * end / 5;
      const Eigen::Index samples = end - first;
      const PatternPart part = model.part(p, first, samples);
      REQUIRE(part.first == first);
      REQUIRE(part.samples == samples);
      REQUIRE((part.mean - meanUnder(model, p, {}, first, samples)).norm() < 1e-12);
      for (int i = 0; i < TwistCorrection::kCommon + TwistCorrection::kOwn; ++i) {
        // The loss of turning due to lag is spread over the whole pattern.
        if (i == TwistCorrection::kYawLag && samples < model.profile(p).samples()) continue;
        INFO(set.patterns()[p].name << ", samples " << samples << ", correction " << i);
        // A lag beyond a sample is not linear for a winding profile.
        const TwistCorrection step = only(i, i == TwistCorrection::kLag ? 0.05 : 0.3);
        SetCorrection all = SetCorrection::none(model.patterns());
        all.common = step.common;
        all.own.col(static_cast<Eigen::Index>(p)) = step.own;
        const Eigen::Vector3d expected = part.mean + part.toBody() * all.added(part);
        REQUIRE((meanUnder(model, p, step, first, samples) - expected).norm() < 1e-12);
      }
    }
}

TEST_CASE("the lever of a pattern's end is the change that a steady twist makes to it") {
  const PatternSet set = windingSet();
  const GroundModel model(GroundConfig{}, set);
  constexpr double kStep = 1e-5;
  for (size_t p = 0; p < model.patterns(); ++p)
    for (int axis = 0; axis < 3; ++axis) {
      const auto moved = [&](double step) {
        Pose2 at, last;
        for (const Pose2& pose : set.patterns()[p].trajectory) {
          Twist2 twist = twistTo(between(last, pose), 0.05);
          last = pose;
          (axis == 0 ? twist.v_x : axis == 1 ? twist.v_y : twist.omega) += step;
          at = at * integrate(twist, 0.05);
        }
        return at;
      };
      const Pose2 up = moved(kStep), down = moved(-kStep);
      const auto column = model.profile(p).endLever().col(axis);
      // To first order in the turn per sample.
      REQUIRE(column[0] == Approx((up.x - down.x) / (2.0 * kStep)).margin(3e-4));
      REQUIRE(column[1] == Approx((up.y - down.y) / (2.0 * kStep)).margin(3e-4));
      REQUIRE(column[2] == Approx((up.yaw - down.yaw) / (2.0 * kStep)).margin(3e-4));
    }
}

TEST_CASE("the noise of a part grows with its shortness, the whole is its longest part") {
  const GroundModel model(GroundConfig{}, windingSet());
  for (size_t p = 0; p < model.patterns(); ++p) {
    const PatternPart& whole = model.whole(p);
    REQUIRE(whole.samples == model.profile(p).samples());
    double metres = 0.0;
    for (Eigen::Index samples = 1; samples <= whole.samples; ++samples) {
      const PatternPart part = model.part(p, 0, samples);
      REQUIRE(part.metres >= metres);
      metres = part.metres;
      REQUIRE(part.noise.minCoeff() > 0.0);
      // An error of 1 cm at the end is large for a short pattern.
      const double seconds = 0.05 * static_cast<double>(samples);
      REQUIRE(part.noise[0] >= 1e-4 / (seconds * seconds));
      if (samples == 1) REQUIRE(part.noise[0] > 10.0 * whole.noise[0]);
    }
    REQUIRE(metres == Approx(whole.metres));
    REQUIRE(model.part(p, 0, whole.samples).noise == whole.noise);
  }
}

TEST_CASE("noise of an execution is as configured, and partly as recorded where that is known") {
  PatternSetContent content = richContent();
  content.patterns[kAhead].end_covariance = {0.01, 0.0, 0.0, 0.01, 0.0, 0.01};
  const GroundConfig config;
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
  // 0.1 m in a second of straight driving.
  const GroundModel recorded(config, checked(content));
  REQUIRE(recorded.whole(kAhead).noise[0] == Approx(0.1 * ahead[0] + 0.9 * 0.01));
  REQUIRE(recorded.whole(kTurnLeft).noise == plain.whole(kTurnLeft).noise);
}

TEST_CASE("a recorded spread of nothing makes no execution exact") {
  PatternSetContent content = richContent();
  // As in recordings of a simulator without yaw noise.
  for (MotionPattern& pattern : content.patterns)
    pattern.end_covariance = {7e-4, 0.0, 0.0, 1e-3, 0.0, 0.0};
  const RuleConfig config = ruleConfig("multi_model");
  const GroundModel model(config.ground, checked(content));
  for (size_t p = 0; p < model.patterns(); ++p) REQUIRE(model.whole(p).noise.minCoeff() > 0.0);
  Pupil pupil(config, checked(content));
  for (int i = 0; i < 20; ++i)
    for (size_t p = 0; p < pupil.patterns(); ++p)
      pupil.learn(p, under({1.1, i % 2 == 0 ? 1.0 : 1.1, 0.0, 0.0}, pupil.shipped(p)));
  for (const double number : pupil.everything()) REQUIRE(std::isfinite(number));
  for (const double number : pupil.rule().memory()) REQUIRE(std::isfinite(number));
}

TEST_CASE("patterns are alike as neighbours and mirror images are, where the set has one axis") {
  const GroundModel model(GroundConfig{}, windingSet());
  REQUIRE(model.scale().isotropy < 0.1);
  for (int own = 0; own < TwistCorrection::kOwn; ++own) {
    const Eigen::MatrixXd& alike = model.alike(static_cast<TwistCorrection::Own>(own));
    REQUIRE((alike - alike.transpose()).norm() < 1e-12);
    REQUIRE(alike.llt().info() == Eigen::Success);
    const auto of = [&](size_t p, size_t q) {
      return alike(static_cast<Eigen::Index>(p), static_cast<Eigen::Index>(q));
    };
    // Slip to one side in a left turn is slip to the other side in a right turn.
    const double mirrored = of(kHardLeft, kHardRight) / of(kHardLeft, kHardLeft);
    if (own == TwistCorrection::kAcross || own == TwistCorrection::kBiasOwn)
      REQUIRE(mirrored < -0.5);
    else
      REQUIRE(mirrored == Approx(0.7).margin(0.03));
    REQUIRE(of(kTurnLeft, kHardLeft) > of(kTurnLeft, kBack));
  }
}

TEST_CASE("whatever the corrections are, a predicted pattern stays one that can be driven") {
  const PatternSet set = windingSet();
  const GroundModel model(GroundConfig{}, set);
  std::mt19937_64 random(9);
  const auto wild = [&] { return chanceOf(random) * std::pow(10.0, 4.0 * chanceOf(random)); };
  const double turn = model.scale().speed / model.scale().turn;
  for (int i = 0; i < 2000; ++i) {
    TwistCorrection correction;
    for (double& number : correction.common) number = wild();
    for (double& number : correction.own) number = wild();
    for (size_t p = 0; p < model.patterns(); ++p) {
      const Pose2 end = model.profile(p).integrateEnd(model.scale(), correction);
      const PatternPart& whole = model.whole(p);
      const double seconds = 0.05 * static_cast<double>(whole.samples);
      const double lag = std::abs(whole.yaw[TwistCorrection::kYawLag - TwistCorrection::kVelocity]);
      REQUIRE(std::hypot(end.x, end.y) <=
              (8.0 * whole.speed + 4.0 * turn * whole.turning) * seconds + 1e-9);
      REQUIRE(std::abs(end.yaw) <=
              (3.0 * whole.turning + 2.0 * whole.speed + 0.5 * lag) * seconds + 1e-9);
    }
  }
}
