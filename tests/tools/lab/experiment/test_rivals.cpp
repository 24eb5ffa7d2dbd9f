// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <cmath>

#include <catch2/catch.hpp>

#include "tests/tools/lab/experiment/drawn_driving.hpp"
#include "tools/lab/experiment/adaptation/tuning.hpp"

namespace tread::adaptation {
namespace {

/// A sample at one speed; variance 0.04 of each velocity.
Sample sampleAt(double v, double w, const Eigen::Vector3d& residual) {
  Sample sample;
  sample.speeds.fill({v, w});
  sample.twist = {v, 0.0, w};
  sample.residual = residual;
  sample.noise.setConstant(0.04);
  return sample;
}

const Functions kForwardOnly = [](const Eigen::Vector2d& speed) {
  return Eigen::VectorXd::Constant(1, speed[0]);
};

TEST_CASE("recursive least squares gives what a calculation by hand gives") {
  // P0 = 0.01, h = 2, R = 0.04: S = 0.08, x = 0.01 2 / 0.08 r = 0.25 r, P = 0.005.
  LinearRival plain(0, kForwardOnly, {Eigen::VectorXd::Constant(1, 0.1)});
  plain.learn(sampleAt(2.0, 0.0, {0.2, 0.0, 0.0}));
  CHECK(plain.offset({1.0, 0.0}) == Approx(0.05));
  // Again: S = 0.06, gain 0.01 / 0.06, innovation 0.2 - 0.1.
  plain.learn(sampleAt(2.0, 0.0, {0.2, 0.0, 0.0}));
  CHECK(plain.offset({1.0, 0.0}) == Approx(0.05 + 0.1 / 6.0));

  // Forgetting by half before the first: P = 0.02, S = 0.12, x = 0.04 / 0.12 0.2.
  LinearRival forgetting(0, kForwardOnly, {Eigen::VectorXd::Constant(1, 0.1), 0.5});
  forgetting.learn(sampleAt(2.0, 0.0, {0.2, 0.0, 0.0}));
  CHECK(forgetting.offset({3.0, 0.0}) == Approx(3.0 * 0.2 / 3.0));

  // A walk with the prior variance has the same effect on the first.
  LinearRival walking(0, kForwardOnly, {Eigen::VectorXd::Constant(1, 0.1), 1.0, 1.0});
  walking.learn(sampleAt(2.0, 0.0, {0.2, 0.0, 0.0}));
  CHECK(walking.offset({1.0, 0.0}) == Approx(0.2 / 3.0));

  // An innovation of 10 standard deviations is weighted with 4 times the noise (10 / 2.5).
  LinearRival wild(0, kForwardOnly, {Eigen::VectorXd::Constant(1, 0.1)});
  const double jump = 10.0 * std::sqrt(0.08);
  wild.learn(sampleAt(2.0, 0.0, {jump, 0.0, 0.0}));
  CHECK(wild.offset({1.0, 0.0}) == Approx(0.02 / (0.04 + 4.0 * 0.04) * jump));
}

TEST_CASE("a Gaussian process of one sample gives what a calculation by hand gives") {
  KernelTuning tuning;
  tuning.deviation = 0.2;
  tuning.length = {1.0, 2.0};
  GaussianProcess process(2, tuning);
  process.learn(sampleAt(1.0, 1.0, {9.0, 9.0, 0.1}));
  // k = 0.04, R = 0.04: half of it at that point; exp(-1) of that at one length scale in each
  // direction.
  CHECK(process.offset({1.0, 1.0}) == Approx(0.05));
  CHECK(process.offset({2.0, 3.0}) == Approx(0.05 * std::exp(-1.0)));
  const Sample one = sampleAt(1.0, 1.0, {0.0, 0.0, 0.1});
  CHECK(GaussianProcess::logLikelihood(2, tuning, &one, 1) ==
        Approx(-0.5 * std::log(2.0 * kPi * 0.08) - 0.5 * 0.01 / 0.08));
  // Two equal samples weigh like one with half the noise.
  process.learn(sampleAt(1.0, 1.0, {9.0, 9.0, 0.1}));
  CHECK(process.offset({1.0, 1.0}) == Approx(0.1 * 0.04 / 0.06));
}

/// Samples of ground with a yaw gain error of `gain`.
std::vector<Sample> ground(double gain, size_t count, uint64_t seed) {
  samples::Draws draws(seed);
  std::vector<Sample> samples;
  for (size_t i = 0; i < count; ++i) {
    const double v = 2.0 * draws.next(), w = 2.0 * draws.next();
    samples.push_back(sampleAt(v, w, {0.0, 0.0, gain * w + 0.02 * draws.next()}));
    samples.back().noise.setConstant(0.0002);
  }
  return samples;
}

TEST_CASE("every rival that was tuned finds the yaw gain of new ground, and keeps the known one") {
  TrainingSamples training;
  for (const double gain : {-0.2, -0.1, 0.0, 0.1, 0.2})
    training.push_back(ground(gain, 62, static_cast<uint64_t>(10.0 * gain + 50.0)));
  for (const std::string& name : rivalNames()) {
    CAPTURE(name);
    const std::unique_ptr<Rival> rival = tunedRival(name, training, 1), home = rival->clone();
    for (const Sample& sample : ground(0.15, 10, 7)) rival->learn(sample);
    for (const Sample& sample : ground(0.0, 10, 8)) home->learn(sample);
    const Sample asked = sampleAt(1.0, 1.0, Eigen::Vector3d::Zero());
    const std::vector<Twist2> reference(kPieceSamples, Twist2{1.0, 0.0, 1.0});
    CHECK(rival->corrected(reference, asked).front().omega == Approx(1.15).margin(0.03));
    CHECK(home->corrected(reference, asked).front().omega == Approx(1.0).margin(0.03));
    CHECK(rival->corrected(reference, asked).front().v_x == Approx(1.0).margin(0.03));
  }
}

TEST_CASE("least squares of gains give what a calculation by hand gives") {
  // P = 0.25 / 0.7, h = 1 and 0.003^2 of noise: x = r P / (P + R).
  const Sample sample = sampleAt(1.0, 0.0, {-0.2, 0.0, 0.0});
  const double P = 0.25 / 0.7, x = -0.2 * P / (P + 9e-6);
  const auto rls2 = tunedRival("rls2", {}, 1), rls3 = tunedRival("rls3", {}, 1);
  rls2->learn(sample);
  rls3->learn(sample);
  const std::vector<Twist2> twists{{1.0, 1.0, 1.0}};
  CHECK(rls2->corrected(twists, sample)[0].v_x == Approx(1.0 + x));
  CHECK(rls2->corrected(twists, sample)[0].v_y == Approx(1.0 + x));
  CHECK(rls2->corrected(twists, sample)[0].omega == 1.0);
  CHECK(rls3->corrected(twists, sample)[0].v_x == Approx(1.0 + x));
  CHECK(rls3->corrected(twists, sample)[0].v_y == 1.0);
}

TEST_CASE("interacting models are sure of calm ground, and take a change at once") {
  const auto imm = tunedRival("imm", {}, 1);
  const auto forward = [&](double gain) {
    Sample sample = sampleAt(1.0, 0.0, {gain, 0.0, 0.0});
    sample.noise.setConstant(0.0004);
    imm->learn(sample);
    return imm->corrected({{1.0, 0.0, 0.0}}, sample)[0].v_x - 1.0;
  };
  for (int i = 0; i < 20; ++i) forward(i % 2 == 0 ? 0.02 : -0.02);
  CHECK(std::abs(forward(0.02)) < 0.015);
  CHECK(forward(-0.4) == Approx(-0.4).margin(0.02));
}

TEST_CASE("hindsight is the regression over the whole session, and a jump does not move it") {
  std::vector<Sample> session = ground(0.15, 60, 9);
  session[7].residual[2] = 30.0;
  const std::unique_ptr<Rival> whole = hindsight(session);
  const Sample asked = sampleAt(0.5, -1.0, Eigen::Vector3d::Zero());
  const std::vector<Twist2> reference(kPieceSamples, Twist2{0.5, 0.0, -1.0});
  CHECK(whole->corrected(reference, asked).back().omega == Approx(-1.15).margin(0.01));
}

TEST_CASE("lagged commands follow the step response of a dead time and a first-order lag") {
  SampledSegment segment;
  segment.before = {0.0, 0.0};
  segment.commands.assign(40, {1.0, 1.0});
  const auto motion = lagged(segment, 1.0, {0.1, 0.5});
  CHECK(motion[1][0] == 0.0);
  // The mean over a sample of 1 - exp(-t / 0.5), from 0.1 s on.
  const auto mean = [](double from) {
    return 1.0 - 0.5 / kPeriod * (std::exp(-from / 0.5) - std::exp(-(from + kPeriod) / 0.5));
  };
  CHECK(motion[2][0] == Approx(mean(0.0)));
  CHECK(motion[20][0] == Approx(mean(0.9)));
  CHECK(motion[20][1] == Approx(0.0).margin(1e-12));
}

TEST_CASE("a reference finds the lag and the gains of what was driven") {
  const SampledSession session = drawnSession("one", "grass", {0.9, 0.6, -0.1}, 40, 0.0, 5);
  const TermTable table(session);
  const Reference reference({&table});
  CHECK(reference.lag(0).delay == 0.2);
  CHECK(reference.lag(0).time_constant == 0.3);
  CHECK(reference.lag(2).delay == 0.2);
  const Predicted said = predicted(session, reference);
  for (size_t i = 0; i < session.pieces.size(); ++i) {
    CAPTURE(i);
    const Pose2 end = integrated(said.twists[i]).back();
    CHECK(distanceBetween(end, session.pieces[i].measured.back()) < 0.02);
    CHECK(std::abs(end.yaw - session.pieces[i].measured.back().yaw) < 0.01);
  }
}

TEST_CASE("the noise of executions is what two under one steady command differ by") {
  std::vector<std::vector<Sample>> sessions(1);
  samples::Draws draws(3);
  for (int i = 0; i < 4000; ++i) {
    const double v = i % 4 < 2 ? 1.0 : 2.0;
    // A residual of the command and one of the execution: uniform, variance 0.3^2 v^2 / 3.
    Sample sample = sampleAt(v, 0.0, {0.5 * v + 0.3 * v * draws.next(), 0.0, 0.0});
    sample.repeats = i % 2 == 1;
    sessions[0].push_back(sample);
  }
  const NoiseModel noise = noiseOf(sessions);
  CHECK(noise.of({1.0, 0.0})[0] == Approx(0.03).epsilon(0.1));
  CHECK(noise.of({2.0, 0.0})[0] == Approx(0.12).epsilon(0.1));
}

}  // namespace
}  // namespace tread::adaptation
