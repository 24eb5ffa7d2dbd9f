// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// The local filter, and what the bank shares with it: convergence, transfer, change, covariance.
#include <catch2/catch.hpp>

#include <Eigen/Eigenvalues>

#include "modules/learner/core/rules/ground_filter.hpp"
#include "tests/helpers.hpp"
#include "tests/learner/rule_bench.hpp"

using namespace tread;
using namespace tread::learner;
using namespace tread::learner::samples;
using tread::testing::effort;

namespace {

const Rule kFilters[] = {"local_filter", "bank"};
/// As the configuration expects of one execution.
constexpr EffectSpread kUsual{0.03, 0.08, 0.03};

void driveRound(Pupil& pupil, const GroundEffect& ground) {
  for (size_t p = 0; p < pupil.patterns(); ++p) pupil.learn(p, under(ground, pupil.shipped(p)));
}

/// Any patterns with chance; returns the largest and the mean change probability.
std::pair<double, double> driveAny(Pupil& pupil, const GroundEffect& ground,
                                   const EffectSpread& spread, int executions,
                                   std::mt19937_64& random) {
  double largest = 0.0;
  double sum = 0.0;
  for (int i = 0; i < executions; ++i) {
    const size_t p = random() % pupil.patterns();
    const RuleNote note = pupil.learn(p, under(drawn(ground, spread, random), pupil.shipped(p)));
    largest = std::max(largest, note.change_probability);
    sum += note.change_probability;
  }
  return {largest, sum / executions};
}

Eigen::Matrix3d endCovariance(Pupil& pupil, size_t pattern) {
  const PoseCovariance c = *pupil.rule().endCovariance(pattern);
  Eigen::Matrix3d matrix;
  matrix << c[0], c[1], c[2], c[1], c[3], c[4], c[2], c[4], c[5];
  return matrix;
}

/// Share of ends within the ellipse that holds 95 % of a normal distribution.
double covered(Rule rule, const EffectSpread& spread, int learned) {
  constexpr double kQuantile = 5.991;
  int within = 0;
  int all = 0;
  for (uint64_t seed = 1; seed <= static_cast<uint64_t>(effort(200)); ++seed) {
    std::mt19937_64 random(seed);
    std::normal_distribution<double> normal(0.0, 1.0);
    const GroundEffect ground{1.0 + 0.07 * normal(random), 1.0 + 0.14 * normal(random),
                              0.1 * normal(random), 0.015 * normal(random)};
    Pupil pupil(ruleConfig(rule), richSet());
    driveAny(pupil, ground, spread, learned, random);
    for (size_t p = 0; p < pupil.patterns(); ++p) {
      const Pose2 end = under(drawn(ground, spread, random), pupil.shipped(p)).back();
      const Eigen::Vector2d apart = end.position() - pupil.end(p).position();
      const Eigen::Matrix2d covariance = endCovariance(pupil, p).topLeftCorner<2, 2>();
      within += apart.dot(covariance.inverse() * apart) < kQuantile ? 1 : 0;
      ++all;
    }
  }
  return static_cast<double>(within) / all;
}

/// A filter that is fed with mean twists about the shipped ones.
struct FedFilter {
  explicit FedFilter(const FilterConfig& config)
      : model(std::make_shared<GroundModel>(config, richSet())), filter(model, config) {}

  void feed(double scale, std::mt19937_64& random) {
    std::normal_distribution<double> normal(0.0, scale);
    const size_t p = random() % model->patterns();
    const Eigen::Vector3d error(normal(random), normal(random), normal(random));
    filter.update(p, model->profile(p).mean() + error);
  }
  double leastEigenvalue() const {
    return Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd>(filter.covariance())
        .eigenvalues()
        .minCoeff();
  }

  std::shared_ptr<GroundModel> model;
  GroundFilter filter;
};

}  // namespace

TEST_CASE(
    "exact measurements of all patterns on changed ground: all predictions become the truth") {
  const GroundEffect ground{1.1, 1.3, 0.1, 0.03};
  for (const Rule& rule : kFilters) {
    INFO(rule);
    Pupil pupil(ruleConfig(rule), richSet());
    const double at_first = meanEndError(pupil, ground);
    const double yaw_at_first = meanYawError(pupil, ground);
    driveRound(pupil, ground);
    REQUIRE(meanEndError(pupil, ground) < 0.2 * at_first);
    REQUIRE(meanYawError(pupil, ground) < 0.2 * yaw_at_first);
    for (int round = 2; round <= 40; ++round) driveRound(pupil, ground);
    for (size_t p = 0; p < pupil.patterns(); ++p) {
      const std::vector<Pose2> truth = under(ground, pupil.shipped(p));
      const std::vector<Pose2> predicted = pupil.prediction(p);
      for (size_t t = 0; t < truth.size(); ++t) {
        REQUIRE(distance(predicted[t], truth[t]) < 1e-3);
        REQUIRE(std::abs(predicted[t].yaw - truth[t].yaw) < 1e-3);
      }
    }
  }
}

TEST_CASE("without a measurement the filters predict what was shipped") {
  for (const Rule& rule : kFilters) {
    const Pupil pupil(ruleConfig(rule), richSet());
    for (size_t p = 0; p < pupil.patterns(); ++p) {
      const std::vector<Pose2> predicted = pupil.prediction(p);
      for (size_t t = 0; t < predicted.size(); ++t) {
        REQUIRE(distance(predicted[t], pupil.shipped(p)[t]) < 1e-12);
        REQUIRE(predicted[t].yaw == Approx(pupil.shipped(p)[t].yaw).margin(1e-12));
      }
    }
  }
}

TEST_CASE("the end that a rule states alone is the last pose that it predicts") {
  for (const Rule& rule : ruleNames()) {
    Pupil pupil(ruleConfig(rule), richSet());
    std::mt19937_64 random(8);
    for (int i = 0; i < 30; ++i) {
      const size_t executed = random() % pupil.patterns();
      pupil.learn(executed,
                  under(drawn({1.1, 1.2, 0.1, 0.0}, kUsual, random), pupil.shipped(executed)));
      for (size_t p = 0; p < pupil.patterns(); ++p) {
        const Pose2 last = pupil.prediction(p).back();
        REQUIRE(distance(pupil.end(p), last) < 1e-12);
        REQUIRE(pupil.end(p).yaw == Approx(last.yaw).margin(1e-12));
      }
    }
  }
}

TEST_CASE("one execution of left corrects right about as much") {
  for (const Rule& rule : kFilters) {
    for (const GroundEffect& ground :
         {GroundEffect{1.0, 1.4, 0.0, 0.0}, GroundEffect{0.9, 1.2, 0.1, 0.0},
          GroundEffect{1.0, 0.7, 0.0, 0.0}, GroundEffect{1.0, 1.0, 0.2, 0.0}}) {
      Pupil pupil(ruleConfig(rule), richSet());
      pupil.learn(kTurnLeft, under(ground, pupil.shipped(kTurnLeft)));
      const auto corrected = [&](size_t p) {
        const std::vector<Pose2> truth = under(ground, pupil.shipped(p));
        return 1.0 - distance(pupil.end(p), truth.back()) /
                         distance(pupil.shipped(p).back(), truth.back());
      };
      // Measured: left by .60 to .70, right by .48 to .59 of its error.
      REQUIRE(corrected(kTurnLeft) > 0.5);
      REQUIRE(corrected(kTurnRight) > 0.7 * corrected(kTurnLeft));
      REQUIRE(corrected(kTurnRight) <= corrected(kTurnLeft));
    }
  }
}

TEST_CASE("a jump of the ground is flagged, unchanged ground is not") {
  Pupil pupil(ruleConfig("local_filter"), richSet());
  std::mt19937_64 random(3);
  // Measured: .05 at most, .03 in the mean.
  const auto [largest, mean] = driveAny(pupil, {1.05, 1.1, 0.0, 0.0}, kUsual, 1000, random);
  REQUIRE(largest < 0.2);
  REQUIRE(mean < 0.05);
  const GroundEffect ice{0.4, 1.0, 0.0, 0.0};
  for (const size_t executed : {kAhead, kTurnLeft, kTurnRight, kHardLeft, kHardRight, kBack}) {
    Pupil jumped(pupil);
    const RuleNote note = jumped.learn(executed, under(ice, pupil.shipped(executed)));
    REQUIRE(note.change_probability > 0.9);
  }
}

TEST_CASE("a change opens the covariance, so that the next executions count for more") {
  Pupil settled(ruleConfig("local_filter"), richSet());
  std::mt19937_64 random(4);
  driveAny(settled, {}, kUsual, 100, random);
  const double before = endCovariance(settled, kHardLeft).topLeftCorner<2, 2>().trace();
  REQUIRE(before <
          0.7 * endCovariance(*std::make_unique<Pupil>(ruleConfig("local_filter"), richSet()),
                              kHardLeft)
                    .topLeftCorner<2, 2>()
                    .trace());
  settled.learn(kTurnLeft, under({0.4, 0.6, 0.0, 0.0}, settled.shipped(kTurnLeft)));
  REQUIRE(endCovariance(settled, kHardLeft).topLeftCorner<2, 2>().trace() > 1.2 * before);
}

TEST_CASE("end covariances are symmetric, positive definite and finite, whatever was learned") {
  for (const Rule& rule : kFilters) {
    INFO(rule);
    Pupil pupil(ruleConfig(rule), richSet());
    std::mt19937_64 random(5);
    for (int i = 0; i < effort(400); ++i) {
      const EffectSpread wild{0.5, 0.8, 0.5};
      driveAny(pupil, {1.0, 1.0, 0.0, 0.0}, i % 3 == 0 ? wild : kUsual, 1, random);
      for (size_t p = 0; p < pupil.patterns(); ++p) {
        const Eigen::Matrix3d covariance = endCovariance(pupil, p);
        REQUIRE(covariance.allFinite());
        REQUIRE(covariance.llt().info() == Eigen::Success);
      }
    }
  }
}

TEST_CASE("rules that know no covariance say so") {
  for (const Rule rule : {"off", "single", "collective", "telescoping"})
    REQUIRE_FALSE(Pupil(ruleConfig(rule), richSet()).rule().endCovariance(0));
}

TEST_CASE("about 95 percent of ends are within the covariance that is stated for them") {
  // Measured after 0, 5 and 40 executions. Spread as configured: filter 1.00, 1.00, 1.00,
  // bank 1.00, 1.00, .94. Twice that spread: filter .99, .96, .95, bank .99, .96, .83, because a
  // new surface's noise is told too low by the few executions that made it. The filter is cautious
  // by intent.
  for (const Rule& rule : kFilters) {
    INFO(rule);
    for (const int learned : {0, 5, 40}) {
      INFO(learned << " executions");
      REQUIRE(covered(rule, kUsual, learned) > 0.9);
      REQUIRE(covered(rule, {0.06, 0.16, 0.06}, learned) > 0.7);
    }
  }
}

TEST_CASE("the filter stays symmetric and positive definite over 100 000 updates, absurd or not") {
  for (const double scale : {0.05, 3.0, 1e5}) {
    INFO(scale);
    FedFilter fed{FilterConfig{}};
    std::mt19937_64 random(6);
    for (int i = 0; i < effort(33000); ++i) {
      fed.feed(i % 5 == 0 ? scale : 0.05, random);
      if (i % 200 != 0) continue;
      REQUIRE(fed.filter.covariance() == fed.filter.covariance().transpose());
      REQUIRE(fed.filter.covariance().allFinite());
      REQUIRE(fed.filter.mean().allFinite());
      REQUIRE(fed.leastEigenvalue() > 1e-5);
    }
  }
}

TEST_CASE("the filter merges its two hypotheses to their common mean and covariance") {
  // Against the equations of the header, written out with dense matrices.
  const FilterConfig config;
  FedFilter fed(config);
  std::mt19937_64 random(7);
  for (int i = 0; i < 20; ++i) fed.feed(0.1, random);
  const GroundModel& model = *fed.model;
  const size_t p = kHardLeft;
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(3, model.dimension());
  H.leftCols<7>() = model.profile(p).meanResponse().leftCols<7>();
  H.middleCols<3>(GroundModel::ownAt(p)) = model.profile(p).meanResponse().rightCols<3>();
  const Eigen::VectorXd x = fed.filter.mean();
  const Eigen::MatrixXd P = fed.filter.covariance();
  const Eigen::MatrixXd& Q = model.changeCovariance();
  const Eigen::Matrix3d R = config.caution * config.caution * model.noise(p);
  const Eigen::Vector3d z = model.profile(p).mean() + Eigen::Vector3d(0.2, 0.1, 0.3);
  const Eigen::Vector3d y = z - model.profile(p).mean() - H * x;
  const Eigen::MatrixXd P_k[2] = {(1.0 - config.drift) * P + config.drift * config.steady * Q,
                                  P + Q};
  const double prior[2] = {1.0 - config.hazard, config.hazard};
  Eigen::VectorXd x_k[2];
  Eigen::MatrixXd after[2];
  double w[2];
  for (int k = 0; k < 2; ++k) {
    const Eigen::Matrix3d S = H * P_k[k] * H.transpose() + R;
    const Eigen::MatrixXd K = P_k[k] * H.transpose() * S.inverse();
    x_k[k] = x + K * y;
    after[k] = P_k[k] - K * H * P_k[k];
    w[k] = prior[k] * std::exp(-0.5 * y.dot(S.inverse() * y)) / std::sqrt(S.determinant());
  }
  const double total = w[0] + w[1];
  const Eigen::VectorXd mean = (w[0] * x_k[0] + w[1] * x_k[1]) / total;
  Eigen::MatrixXd covariance = Eigen::MatrixXd::Zero(x.size(), x.size());
  for (int k = 0; k < 2; ++k)
    covariance += w[k] / total * (after[k] + (x_k[k] - mean) * (x_k[k] - mean).transpose());
  fed.filter.update(p, z);
  REQUIRE((fed.filter.mean() - mean).cwiseAbs().maxCoeff() < 1e-10);
  REQUIRE((fed.filter.covariance() - covariance).cwiseAbs().maxCoeff() < 1e-10);
  REQUIRE(fed.filter.changeProbability() == Approx(w[1] / total));
}

TEST_CASE("a twist profile responds to its corrections as its derivatives say") {
  const PatternSet set = richSet();
  for (const MotionPattern& pattern : set.patterns()) {
    const TwistProfile profile(pattern, 0.05);
    for (int i = 0; i < TwistCorrection::kAll; ++i) {
      INFO(pattern.name << ", correction " << i);
      constexpr double kStep = 1e-5;
      Correction10 step = Correction10::Zero();
      step[i] = kStep;
      const Pose2 up = profile.integrateEnd(step);
      const Pose2 down = profile.integrateEnd(-step);
      // To first order in the turn of one sample.
      const auto column = profile.endResponse().col(i);
      REQUIRE(column[0] == Approx((up.x - down.x) / (2.0 * kStep)).margin(3e-4));
      REQUIRE(column[1] == Approx((up.y - down.y) / (2.0 * kStep)).margin(3e-4));
      REQUIRE(column[2] == Approx((up.yaw - down.yaw) / (2.0 * kStep)).margin(3e-4));
      // A mean twist is corrected exactly by the matrix, also far from zero.
      step[i] = 0.3;
      std::vector<double> numbers(3 * pattern.trajectory.size());
      const auto samples = static_cast<Eigen::Index>(pattern.trajectory.size());
      profile.integrate(step, Trajectory(numbers.data(), samples, 3));
      const Eigen::Vector3d mean = meanTwist(ConstTrajectory(numbers.data(), samples, 3), 0.05);
      const Eigen::Vector3d expected = profile.mean() + profile.meanResponse() * step;
      REQUIRE((mean - expected).cwiseAbs().maxCoeff() < 1e-12);
    }
  }
}

TEST_CASE("whatever the corrections are, a predicted pattern stays one that can be driven") {
  const PatternSet set = richSet();
  std::mt19937_64 random(9);
  std::normal_distribution<double> normal(0.0, 1.0);
  for (int i = 0; i < 2000; ++i) {
    Correction10 correction;
    for (int k = 0; k < TwistCorrection::kAll; ++k)
      correction[k] = normal(random) * std::pow(10.0, 4.0 * normal(random));
    for (const MotionPattern& pattern : set.patterns()) {
      const TwistProfile profile(pattern, 0.05);
      const Pose2 end = profile.integrateEnd(correction);
      REQUIRE(std::hypot(end.x, end.y) <= 5.0 * profile.meanSpeed() * profile.duration() + 1e-9);
      REQUIRE(std::abs(end.yaw) <=
              (3.0 * profile.meanTurn() + 0.5 * profile.meanSpeed()) * profile.duration() + 1e-9);
    }
  }
}

TEST_CASE("no hazard and a certain change are configurations like others") {
  for (const double hazard : {0.0, 0.9}) {
    RuleConfig config = ruleConfig("local_filter");
    config.filter.hazard = hazard;
    Pupil pupil(config, richSet());
    std::mt19937_64 random(10);
    driveAny(pupil, {1.1, 1.2, 0.0, 0.0}, kUsual, 100, random);
    REQUIRE(meanEndError(pupil, {1.1, 1.2, 0.0, 0.0}) < 0.03);
  }
}
