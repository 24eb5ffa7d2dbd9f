// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include <Eigen/LU>

#include "core_rig.hpp"
#include "modules/identification/core/observations.hpp"
#include "modules/identification/core/pruning.hpp"
#include "modules/identification/core/screening.hpp"

using namespace tread;
using namespace tread::gap;
using samples::blockNoise;
using samples::Rig;
using samples::waves;

namespace {

/// Gain of three parameters with waves as directions, on left-out blocks.
Gain gainOfThree(const Rig& rig, const Eigen::VectorXd& residuals) {
  const FitState none = rig.stateOf(residuals, 1.0);
  FitState three = none;
  three.jacobian = waves(rig.data, 3);
  for (const char* path : {"yaw_pull.pull", "slip_ratio.slip", "track_asymmetry.share"})
    three.free.push_back(freeParameter(three.model, path));
  return gap::gainOf(heldOutLoss(rig.fitter, none), heldOutLoss(rig.fitter, three),
                     rig.fitter.blocksThatCount());
}

/// A vehicle at rest: its gyro has a bias with noise that is common within each block.
Drive standingDrive(double bias, double seconds, uint64_t seed) {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> gauss(0.0, 1.0);
  Drive drive;
  drive.name = "standing";
  Segment segment;
  segment.commands.push_back({0.0, {}});
  segment.end = seconds;
  constexpr double kBlock = 20.0;
  double common = 0.0;
  double until = 0.0;
  for (double time = 0.0; time < seconds; time += 0.1) {
    if (time >= until - 1e-9) {
      common = 0.01 * gauss(random);
      until += kBlock;
    }
    InsSample sample;
    sample.time = time;
    sample.T_map_body = {kNotMeasured, kNotMeasured, kNotMeasured};
    sample.omega = bias + common + 0.02 * gauss(random);
    segment.ins.push_back(sample);
  }
  drive.segments.push_back(std::move(segment));
  return drive;
}

}  // namespace

TEST_CASE("parameters that only follow noise do not gain on blocks left out") {
  const Rig rig({}, 300.0, 1);
  double sum = 0.0;
  constexpr int kSeeds = 60;
  for (uint64_t seed = 1; seed <= kSeeds; ++seed)
    sum += gainOfThree(rig, blockNoise(rig.data, seed)).value;
  CHECK(sum / kSeeds < 0.0);
}

TEST_CASE("a parameter that is in the residuals gains on blocks left out, beyond its error") {
  const Rig rig({}, 300.0, 1);
  const Eigen::VectorXd hidden = 1.0 * waves(rig.data, 3).col(1);
  int sure = 0;
  for (uint64_t seed = 1; seed <= 20; ++seed) {
    const Gain gain = gainOfThree(rig, blockNoise(rig.data, seed) + hidden);
    sure += gain.value > 2.0 * gain.error;
  }
  CHECK(sure >= 18);
}

TEST_CASE("a gain is the sum over the blocks that count, its error from their scatter") {
  Eigen::VectorXd first(4), second(4);
  first << 3.0, 5.0, 100.0, 4.0;
  second << 1.0, 1.0, 0.0, 1.0;
  const Gain gain = gap::gainOf(first, second, {1, 1, 0, 1});
  CHECK(gain.value == Approx(9.0));
  CHECK(gain.error == Approx(std::sqrt(3.0)));  // 2, 4 and 3: variance 1, times 3
}

TEST_CASE("the 95 percent interval from the blocks' scatter covers the truth 95 times of 100") {
  constexpr int kSeeds = 200;
  constexpr double kBias = 0.03;
  int covered = 0;
  for (uint64_t seed = 1; seed <= kSeeds; ++seed) {
    const std::vector<Drive> drives{standingDrive(kBias, 400.0, seed)};
    ObservationSettings settings;
    settings.gyro_bin = 1.0;
    settings.piece = 1.0;
    const Observations data(drives, settings);
    const Fitter fitter(data);
    const ModelDocument model = syntheticVehicle();
    FitState state = fitter.start(model, {freeParameter(model, "gyro_bias.rate")});
    fitter.fitRoughly(state);
    fitter.renewNoise(state);  // for a worse fit it is too large
    fitter.fit(state);
    const double half =
        studentQuantile(data.blocks() - 1) * std::sqrt(parameterCovariance(fitter, state)(0, 0));
    covered += std::abs(*findParameter(state.model, "gyro_bias.rate") - kBias) < half;
  }
  // 190 are expected; .1 % of all correct intervals are outside of these limits.
  CHECK(covered >= 179);
  CHECK(covered <= 198);
}

TEST_CASE("a parameter that the drive does not show is as good as unknown") {
  const Rig rig({}, 240.0, 1);
  FitState state = rig.stateOf(blockNoise(rig.data, 1), 1.0);
  state.jacobian = waves(rig.data, 2);
  state.jacobian.col(1) = 2.0 * state.jacobian.col(0);
  for (const char* path : {"yaw_pull.pull", "track_asymmetry.share"})
    state.free.push_back(freeParameter(state.model, path));
  const Eigen::MatrixXd covariance = parameterCovariance(rig.fitter, state);
  for (Eigen::Index i : {0, 1}) {
    const FreeParameter& parameter = state.free[static_cast<size_t>(i)];
    CHECK(std::sqrt(covariance(i, i)) > parameter.max - parameter.min);
  }
}

TEST_CASE("what a block says is in no parameter that its own loss is told with") {
  const Rig rig({}, 300.0, 1);
  FitState state = rig.stateOf(blockNoise(rig.data, 1), 1.0);
  state.jacobian = waves(rig.data, 3);
  for (const char* path : {"yaw_pull.pull", "slip_ratio.slip", "track_asymmetry.share"})
    state.free.push_back(freeParameter(state.model, path));
  const Eigen::VectorXd loss = heldOutLoss(rig.fitter, state);
  constexpr int kChanged = 4;
  for (Eigen::Index i = 0; i < rig.size(); ++i)
    if (rig.data.all()[static_cast<size_t>(i)].block == kChanged) state.predicted[i] -= 3.0;
  const Eigen::VectorXd other = heldOutLoss(rig.fitter, state);
  CHECK(other[kChanged] > loss[kChanged] + 100.0);
  int unmoved = 0;
  for (Eigen::Index b = 0; b < loss.size(); ++b) unmoved += other[b] == loss[b];
  // Blocks left out together with it: their parameters did not use it.
  CHECK(unmoved == (rig.data.blocks() - 1) / 5);
}

TEST_CASE("without free parameters the held out loss is that of each block's rows") {
  const Rig rig({}, 200.0, 1);
  const Eigen::VectorXd residuals = blockNoise(rig.data, 1);
  const FitState state = rig.stateOf(residuals, 0.7);
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(rig.data.blocks());
  for (Eigen::Index i = 0; i < rig.size(); ++i)
    expected[rig.data.all()[static_cast<size_t>(i)].block] += lossOf(residuals[i], 0.7);
  const Eigen::VectorXd loss = heldOutLoss(rig.fitter, state);
  CHECK((loss - expected).cwiseAbs().maxCoeff() < 1e-9);
  CHECK(loss.sum() == Approx(totalLoss(residuals, state.scales, rig.fitter.mask())));
}

TEST_CASE("the held out loss of small residuals is that of least squares on the other blocks") {
  const Rig rig({}, 300.0, 1);
  constexpr double kScale = 1e3;  // so large that the loss is a parabola
  const Eigen::VectorXd residuals = blockNoise(rig.data, 2);
  FitState state = rig.stateOf(residuals, kScale);
  state.jacobian = waves(rig.data, 3);
  state.jacobian.col(2) += 0.5 * state.jacobian.col(0);
  for (const char* path : {"yaw_pull.pull", "slip_ratio.slip", "track_asymmetry.share"})
    state.free.push_back(freeParameter(state.model, path));
  const Eigen::VectorXd loss = heldOutLoss(rig.fitter, state);
  Eigen::VectorXd expected = Eigen::VectorXd::Zero(rig.data.blocks());
  for (int fold = 0; fold < 5; ++fold) {
    Eigen::MatrixXd train = state.jacobian;
    Eigen::VectorXd right = residuals;
    for (Eigen::Index i = 0; i < rig.size(); ++i)
      if (rig.data.all()[static_cast<size_t>(i)].block % 5 == fold) {
        train.row(i).setZero();
        right[i] = 0.0;
      }
    const Eigen::VectorXd fitted =
        (train.transpose() * train).inverse() * Eigen::VectorXd(train.transpose() * right);
    const Eigen::VectorXd outside = residuals - state.jacobian * fitted;
    for (Eigen::Index i = 0; i < rig.size(); ++i) {
      const int block = rig.data.all()[static_cast<size_t>(i)].block;
      if (block % 5 == fold) expected[block] += lossOf(outside[i], kScale);
    }
  }
  for (Eigen::Index b = 0; b < loss.size(); ++b)
    CHECK(loss[b] == Approx(expected[b]).epsilon(1e-4));
}

TEST_CASE("a parameter that is known for certain follows nothing") {
  const Rig rig({}, 200.0, 1);
  const FitState none = rig.stateOf(blockNoise(rig.data, 1) + waves(rig.data, 1).col(0), 1.0);
  FitState held = none;
  held.free.push_back(freeParameter(held.model, "yaw_pull.pull"));
  held.free[0].expected = 0.0;
  held.free[0].deviation = 1e-9;
  held.jacobian = waves(rig.data, 1);
  const Eigen::VectorXd without = heldOutLoss(rig.fitter, none);
  CHECK((heldOutLoss(rig.fitter, held) - without).cwiseAbs().maxCoeff() < 1e-6);
  held.free[0].deviation = std::numeric_limits<double>::infinity();
  CHECK(heldOutLoss(rig.fitter, held).sum() < without.sum() - 10.0);
}

TEST_CASE("rows that do not count have no held out loss and change no other") {
  const Rig rig({}, 300.0, 1);
  std::vector<char> mask;
  for (const Observation& row : rig.data.all()) mask.push_back(row.block % 3 != 1);
  FitState state = rig.stateOf(blockNoise(rig.data, 1), 1.0);
  state.jacobian = waves(rig.data, 1);
  state.free.push_back(freeParameter(state.model, "yaw_pull.pull"));
  const Fitter part = rig.fitter.onRows(mask);
  const std::vector<char> counts = part.blocksThatCount();
  const Eigen::VectorXd loss = heldOutLoss(part, state);
  for (Eigen::Index i = 0; i < rig.size(); ++i)
    if (!mask[static_cast<size_t>(i)]) state.predicted[i] = 1e6;
  const Eigen::VectorXd same = heldOutLoss(part, state);
  for (Eigen::Index b = 0; b < loss.size(); ++b) {
    CHECK((counts[static_cast<size_t>(b)] != 0) == (b % 3 != 1));
    CHECK((loss[b] == 0.0) == (b % 3 == 1));
    CHECK(same[b] == loss[b]);
  }
}

TEST_CASE("parameters that follow the residuals in first order leave the model as it was") {
  const Rig rig({}, 200.0, 1);
  const Eigen::MatrixXd directions = waves(rig.data, 2);
  FitState state = rig.stateOf(blockNoise(rig.data, 1) + 0.7 * directions.col(0), 1e3);
  state.free.push_back(freeParameter(state.model, "yaw_pull.pull"));
  state.jacobian = directions.col(0);
  const Eigen::VectorXd before = state.predicted;
  followLinearly(rig.fitter, state);
  CHECK(*findParameter(state.model, "yaw_pull.pull") == 0.0);
  // Along the direction only, until the residuals contain nothing of it.
  const Eigen::VectorXd moved = state.predicted - before;
  const double size = moved.dot(directions.col(0)) / directions.col(0).squaredNorm();
  CHECK(size == Approx(0.7).margin(0.2));
  CHECK((moved - size * directions.col(0)).norm() < 1e-9);
  CHECK(rig.data.residuals(state.predicted).dot(directions.col(0)) ==
        Approx(0.0).margin(1e-3 * directions.col(0).squaredNorm()));
}

TEST_CASE("the covariance is the scatter of the blocks' pulls over the information squared") {
  const Rig rig({}, 200.0, 1);
  const Eigen::VectorXd residuals = blockNoise(rig.data, 3);
  FitState state = rig.stateOf(residuals, 0.9);
  state.jacobian = waves(rig.data, 1);
  state.free.push_back(freeParameter(state.model, "yaw_pull.pull"));
  Eigen::VectorXd pulls = Eigen::VectorXd::Zero(rig.data.blocks());
  for (Eigen::Index i = 0; i < rig.size(); ++i)
    pulls[rig.data.all()[static_cast<size_t>(i)].block] +=
        pullOf(residuals[i], 0.9) * state.jacobian(i, 0);
  const double information = 5.0 / 7.0 * state.jacobian.squaredNorm() / (0.9 * 0.9);
  const auto blocks = static_cast<double>(rig.data.blocks());
  const Eigen::MatrixXd covariance = parameterCovariance(rig.fitter, state);
  REQUIRE(covariance.size() == 1);
  CHECK(covariance(0, 0) ==
        Approx(pulls.squaredNorm() * blocks / (blocks - 1.0) / (information * information)));
  state.free[0].deviation = 1e-4;  // far better known than from the drive
  CHECK(parameterCovariance(rig.fitter, state)(0, 0) == Approx(1e-8).epsilon(0.01));
  state.free.clear();
  CHECK(parameterCovariance(rig.fitter, state).size() == 0);
}

TEST_CASE("a covariance is symmetric, has no negative variance and changes with the units") {
  const Rig rig({}, 300.0, 1);
  FitState state = rig.stateOf(blockNoise(rig.data, 4), 1.0);
  state.jacobian = waves(rig.data, 3);
  state.jacobian.col(2) += 0.8 * state.jacobian.col(1);
  for (const char* path : {"yaw_pull.pull", "slip_ratio.slip", "track_asymmetry.share"})
    state.free.push_back(freeParameter(state.model, path));
  const Eigen::MatrixXd covariance = parameterCovariance(rig.fitter, state);
  CHECK((covariance - covariance.transpose()).norm() < 1e-12 * covariance.norm());
  CHECK(covariance.determinant() > 0.0);
  state.jacobian.col(1) *= 1000.0;  // the parameter in thousandths
  const Eigen::MatrixXd other = parameterCovariance(rig.fitter, state);
  CHECK(other(1, 1) == Approx(1e-6 * covariance(1, 1)));
  CHECK(other(1, 2) == Approx(1e-3 * covariance(1, 2)));
  CHECK(other(2, 2) == Approx(covariance(2, 2)));
}

TEST_CASE("a gain of one block has no error, and the other way round it is a loss") {
  Eigen::VectorXd first(2), second(2);
  first << 5.0, 9.0;
  second << 2.0, 1.0;
  const Gain one = gap::gainOf(first, second, {1, 0});
  CHECK(one.value == 3.0);
  CHECK(one.error == 0.0);
  const Gain both = gap::gainOf(first, second, {1, 1});
  const Gain back = gap::gainOf(second, first, {1, 1});
  CHECK(back.value == -both.value);
  CHECK(back.error == both.error);
  CHECK(gap::gainOf(first, second, {0, 0}).value == 0.0);
}

TEST_CASE("a held number moves by chance as far as the rows can pull it, a free one further") {
  const Rig rig({}, 200.0, 1);
  FitState state = rig.stateOf(blockNoise(rig.data, 3), 0.9);
  state.jacobian = waves(rig.data, 1);
  state.free.push_back(freeParameter(state.model, "yaw_pull.pull"));
  const double information = 5.0 / 7.0 * state.jacobian.squaredNorm() / (0.9 * 0.9);
  const double scatter = parameterCovariance(rig.fitter, state)(0, 0) * information * information;
  CHECK(moveCovariance(rig.fitter, state)(0, 0) == Approx(scatter / (information * information)));

  const double deviation = 0.7 / std::sqrt(information);
  state.model.covariance = {{"yaw_pull.pull"}, {{deviation * deviation}}};
  const double known = deviation * deviation;
  CHECK(moveCovariance(rig.fitter, state)(0, 0) ==
        Approx(scatter / (information * information) + known));
  state.free[0].deviation = deviation;
  CHECK(moveCovariance(rig.fitter, state)(0, 0) ==
        Approx((scatter + information * information * known) /
               std::pow(information + 1.0 / known, 2)));
  CHECK(moveCovariance(rig.fitter, FitState{}).size() == 0);
}

TEST_CASE("two numbers that no drive tells apart move by chance as far as they like") {
  const Rig rig({}, 200.0, 1);
  FitState state = rig.stateOf(blockNoise(rig.data, 3), 0.9);
  state.jacobian.resize(rig.size(), 2);
  state.jacobian << waves(rig.data, 1), waves(rig.data, 1);
  state.free = {freeParameter(state.model, "yaw_pull.pull"),
                freeParameter(state.model, "slip_ratio.slip")};
  CHECK(std::isinf(moveCovariance(rig.fitter, state)(0, 0)));
  CHECK(std::isinf(moveCovariance(rig.fitter, state)(1, 1)));
}
