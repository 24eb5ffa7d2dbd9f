// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "core_rig.hpp"
#include "modules/identification/core/likelihood.hpp"
#include "modules/identification/core/validation.hpp"

using namespace tread;
using namespace tread::gap;
using samples::blockNoise;
using samples::Rig;
using samples::waves;

namespace {

/// Gain of three parameters whose directions are waves, on blocks left out.
Gain gainOfThree(const Rig& rig, const Eigen::VectorXd& residuals) {
  const FitState none = rig.stateOf(residuals, 1.0);
  FitState three = none;
  three.jacobian = waves(rig.data, 3);
  for (const char* path : {"yaw_pull.pull", "slip_ratio.slip", "track_asymmetry.share"})
    three.free.push_back(freeParameter(three.model, path));
  return gap::gainOf(heldOutLoss(rig.data, none, rig.all), heldOutLoss(rig.data, three, rig.all),
                     blocksThatCount(rig.data, rig.all));
}

/// A vehicle that stands: its gyro says a bias with noise that each block has in common.
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
    const std::vector<char> all(data.all().size(), 1);
    const ModelDocument model = syntheticVehicle();
    FitState state = fitter.start(model, {freeParameter(model, "gyro_bias.rate")}, all);
    fitter.fitRoughly(state, all);
    fitter.renewNoise(state, all);  // of a worse fit it is too large
    fitter.fit(state, all);
    const double half =
        studentQuantile(data.blocks() - 1) * std::sqrt(parameterCovariance(data, state, all)(0, 0));
    covered += std::abs(*findParameter(state.model, "gyro_bias.rate") - kBias) < half;
  }
  // 190 are expected; a thousandth of all honest intervals lies outside of these.
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
  const Eigen::MatrixXd covariance = parameterCovariance(rig.data, state, rig.all);
  for (Eigen::Index i : {0, 1}) {
    const FreeParameter& parameter = state.free[static_cast<size_t>(i)];
    CHECK(std::sqrt(covariance(i, i)) > parameter.max - parameter.min);
  }
}
