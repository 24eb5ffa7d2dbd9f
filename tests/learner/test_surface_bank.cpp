// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// What a stored surface knows and how two become one, against the equations with dense matrices.
#include <catch2/catch.hpp>

#include <Eigen/LU>

#include "modules/learner/core/rules/ground_filter.hpp"
#include "tests/learner/rule_bench.hpp"

using namespace tread;
using namespace tread::learner;
using namespace tread::learner::samples;

namespace {

std::shared_ptr<const GroundModel> richModel() {
  return std::make_shared<GroundModel>(FilterConfig{}, richSet());
}

/// H of a pattern for the whole state.
Eigen::MatrixXd denseResponse(const GroundModel& model, size_t pattern) {
  Eigen::MatrixXd H = Eigen::MatrixXd::Zero(3, model.dimension());
  const auto& response = model.profile(pattern).meanResponse();
  H.leftCols<7>() = response.leftCols<7>();
  H.middleCols<3>(GroundModel::ownAt(pattern)) = response.rightCols<3>();
  return H;
}

RememberedSurface surface(const GroundModel& model, double gain, double driven, int64_t last_met) {
  RememberedSurface made;
  made.x = Eigen::VectorXd::Zero(model.dimension());
  made.x[TwistCorrection::kForward] = gain;
  made.driven.assign(model.patterns(), driven);
  made.driven[kBack] = 0.0;
  made.noise = {0.5, 1.0, 2.0};
  made.last_met = last_met;
  return made;
}

TwistSample sampleOf(const GroundModel& model, const Eigen::VectorXd& x, size_t pattern,
                     const Eigen::Vector3d& chance) {
  return {pattern, model.meanTwistUnder(x, pattern) + chance};
}

}  // namespace

TEST_CASE("what is not known of a stored surface follows from how often it was driven") {
  const auto model = richModel();
  for (const double driven : {1.0, 7.0, 500.0}) {
    const RememberedSurface stored = surface(*model, 0.1, driven, 1);
    Eigen::MatrixXd information = model->changeCovariance().inverse();
    const double share = std::min(1.0, 200.0 / stored.executions());
    for (size_t p = 0; p < model->patterns(); ++p) {
      const Eigen::MatrixXd H = denseResponse(*model, p);
      const Eigen::Vector3d root = stored.noise.cwiseSqrt();
      const Eigen::Matrix3d R = root.asDiagonal() * model->noise(p) * root.asDiagonal();
      information += share * stored.driven[p] * H.transpose() * R.inverse() * H;
    }
    const KnownSurface known(*model, stored);
    REQUIRE((known.covariance() - information.inverse()).cwiseAbs().maxCoeff() < 1e-10);
    REQUIRE((known.covariance() - known.covariance().transpose()).cwiseAbs().maxCoeff() < 1e-14);
    // The density of an execution: what is not known of the surface and its own noise.
    for (size_t p = 0; p < model->patterns(); ++p) {
      const Eigen::MatrixXd H = denseResponse(*model, p);
      const Eigen::Matrix3d S =
          H * information.inverse() * H.transpose() + known.executionNoise(*model, p);
      const Eigen::Vector3d y(0.03, -0.02, 0.1);
      const double expected =
          -0.5 * (y.dot(S.inverse() * y) + std::log(S.determinant()) + 3.0 * std::log(2.0 * kPi));
      REQUIRE(known.logLikelihood(*model, sampleOf(*model, stored.x, p, y)) ==
              Approx(expected).margin(1e-9));
    }
  }
}

TEST_CASE("two that are one surface become one: what both know, their common prior once") {
  const auto model = richModel();
  SurfaceBank bank(model);
  bank.store(surface(*model, 0.10, 4.0, 3), 16);
  bank.store(surface(*model, 0.11, 2.0, 9), 16);
  bank.store(surface(*model, 0.50, 5.0, 5), 16);
  REQUIRE(bank.alike(0, 1));
  REQUIRE_FALSE(bank.alike(0, 2));
  REQUIRE_FALSE(bank.alike(2, 1));
  const Eigen::MatrixXd first = bank[0].covariance().inverse();
  const Eigen::MatrixXd second = bank[1].covariance().inverse();
  const Eigen::MatrixXd both = first + second - model->changeCovariance().inverse();
  const Eigen::VectorXd x = both.inverse() * (first * bank[0].mean() + second * bank[1].mean());
  bank.merge(0, 1);
  REQUIRE(bank.size() == 2);
  REQUIRE((bank[0].mean() - x).cwiseAbs().maxCoeff() < 1e-9);
  // Equal noise in both: what is known is what six executions of each pattern tell.
  REQUIRE((bank[0].covariance() - both.inverse()).cwiseAbs().maxCoeff() < 1e-9);
  REQUIRE(bank[0].stored().driven[kAhead] == 6.0);
  REQUIRE(bank[0].stored().last_met == 9);
  REQUIRE(bank[0].stored().noise[2] == Approx(2.0));
  REQUIRE(bank[1].mean()[TwistCorrection::kForward] == 0.50);  // moved down
}

TEST_CASE("the noise of two that become one is their mean by executions") {
  const auto model = richModel();
  SurfaceBank bank(model);
  bank.store(surface(*model, 0.1, 9.0, 1), 16);
  RememberedSurface rough = surface(*model, 0.1, 3.0, 2);
  rough.noise = {4.5, 5.0, 6.0};
  bank.store(rough, 16);
  bank.merge(0, 1);
  REQUIRE(bank[0].stored().noise[0] == Approx(1.5));
  REQUIRE(bank[0].stored().noise[1] == Approx(2.0));
  REQUIRE(bank[0].stored().noise[2] == Approx(3.0));
}

TEST_CASE("a stored surface goes on learning its corrections and its noise") {
  const auto model = richModel();
  SurfaceBank bank(model);
  bank.store(surface(*model, 0.0, 2.0, 1), 16);
  Eigen::VectorXd truth = Eigen::VectorXd::Zero(model->dimension());
  truth[TwistCorrection::kForward] = 0.05;
  truth[TwistCorrection::kYaw] = 0.2;
  std::mt19937_64 random(1);
  std::normal_distribution<double> normal(0.0, 1.0);
  for (int block = 1; block <= 60; ++block) {
    std::vector<TwistSample> samples;
    for (int i = 0; i < 10; ++i) {
      const size_t p = random() % model->patterns();
      // Forward as noisy as the model expects, lateral half, yaw twice the deviation.
      const Eigen::Vector3d sigma = model->noise(p).diagonal().cwiseSqrt();
      samples.push_back(sampleOf(*model, truth, p,
                                 {sigma[0] * normal(random), 0.5 * sigma[1] * normal(random),
                                  2.0 * sigma[2] * normal(random)}));
    }
    bank.refine(0, samples, 1 + block);
  }
  const RememberedSurface& learned = bank[0].stored();
  REQUIRE(learned.last_met == 61);
  REQUIRE(learned.executions() == Approx(612.0));
  REQUIRE(learned.noise[0] == Approx(1.0).epsilon(0.3));
  REQUIRE(learned.noise[1] == Approx(0.25).epsilon(0.3));
  REQUIRE(learned.noise[2] == Approx(4.0).epsilon(0.3));
  for (const size_t p : {kAhead, kTurnLeft, kTurnRight, kTurning}) {
    const Eigen::Vector3d apart =
        model->meanTwistUnder(learned.x, p) - model->meanTwistUnder(truth, p);
    REQUIRE(apart.cwiseAbs().maxCoeff() < 0.03);
  }
}

TEST_CASE("a mixture of surfaces is as uncertain as they differ") {
  // Two stored surfaces that are equally likely: the spread between them is in the covariance.
  const auto model = richModel();
  const auto spread_of = [&](double gain) {
    SurfaceBank stored(model);
    stored.store(surface(*model, -gain, 20.0, 1), 16);
    stored.store(surface(*model, gain, 20.0, 1), 16);
    RuleConfig config = ruleConfig("bank");
    config.bank.unknown_prior = 0.001;
    Pupil pupil(config, richSet());
    pupil.rule().adoptBank(stored);
    // In place: tells nothing of the forward gain.
    for (int i = 0; i < 9; ++i) pupil.learn(kTurning, pupil.shipped(kTurning));
    REQUIRE(pupil.end(kAhead).x == Approx(1.0).margin(0.02));
    return std::sqrt((*pupil.rule().endCovariance(kAhead))[0]);
  };
  REQUIRE(spread_of(0.3) > 0.2);
  REQUIRE(spread_of(0.3) - spread_of(0.0) > 0.15);
}

TEST_CASE("the bank makes one of two stored surfaces as soon as it finds them alike") {
  const auto model = richModel();
  SurfaceBank stored(model);
  stored.store(surface(*model, 0.5, 20.0, 1), 16);
  stored.store(surface(*model, 0.0, 2.0, 2), 16);
  stored.store(surface(*model, 0.01, 2.0, 3), 16);
  Pupil pupil(ruleConfig("bank"), richSet());
  pupil.rule().adoptBank(stored);
  RuleNote note;
  for (size_t i = 0; i < 10; ++i) {
    REQUIRE(pupil.rule().bank()->size() == 3);
    note = pupil.learn(i % 7, pupil.shipped(i % 7));
  }
  REQUIRE(pupil.rule().bank()->size() == 2);
  REQUIRE_FALSE(note.surface_stored);
  REQUIRE(note.surface == 2);
  REQUIRE(note.surface_probability > 0.9);
  // The weights of both are its own now: they are still probabilities, or it would not be read.
  Pupil second(pupil);
  REQUIRE(second.rule().restore(TrajectoryTable(pupil.set().patterns()), pupil.rule().memory()));
  REQUIRE(second.everything() == pupil.everything());
}

TEST_CASE("who leaves a known surface for an unknown one leaves from there") {
  const auto model = richModel();
  SurfaceBank stored(model);
  stored.store(surface(*model, 0.5, 20.0, 1), 16);
  Pupil pupil(ruleConfig("bank"), richSet());
  pupil.rule().adoptBank(stored);
  const GroundEffect known{1.5, 1.0, 0.0, 0.0};
  for (int i = 0; i < 5; ++i) pupil.learn(kAhead, under(known, pupil.shipped(kAhead)));
  // 0.3 more on the straight, never met before: of the reverse nothing else is known.
  for (int i = 0; i < 3; ++i)
    pupil.learn(kAhead, under({1.8, 1.0, 0.0, 0.0}, pupil.shipped(kAhead)));
  REQUIRE(pupil.end(kAhead).x == Approx(1.8).margin(0.1));
  REQUIRE(pupil.end(kBack).x < -0.8 * 1.45);
}
