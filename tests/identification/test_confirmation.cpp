// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "core_rig.hpp"
#include "modules/identification/core/pruning.hpp"
#include "modules/identification/core/search_steps.hpp"

using namespace tread;
using namespace tread::gap;
using samples::Rig;
using samples::Values;

namespace {

using Names = std::vector<std::string>;

using samples::kSilent;

/// A finished search with these parameters fitted.
FoundTerms resultOf(const Rig& rig, const Values& begin) {
  FoundTerms result;
  result.calibrated = rig.fitter.start(syntheticVehicle(), {});
  rig.fitter.renewJacobian(result.calibrated);
  result.state = rig.fitted(begin);
  for (const auto& [path, value] : begin) result.effects.push_back(effectOf(path));
  return result;
}

}  // namespace

TEST_CASE("the halves share out the rows by whole blocks, every other one") {
  const Rig rig({}, 100.0, 1);
  const std::vector<char> even = halfMask(rig.data, 0);
  const std::vector<char> odd = halfMask(rig.data, 1);
  REQUIRE(even.size() == rig.data.all().size());
  for (size_t i = 0; i < even.size(); ++i) {
    CHECK(even[i] + odd[i] == 1);
    CHECK((odd[i] != 0) == (rig.data.all()[i].block % 2 == 1));
  }
}

TEST_CASE("an effect of the drive lessens the end error where it was not fitted, and stays") {
  const Rig rig({{"motor_deadband.speed", 0.1}}, 200.0, 2);
  FoundTerms result = resultOf(rig, {{"motor_deadband.speed", 0.05}});
  const double size = *findParameter(result.state.model, "motor_deadband.speed");
  dropUnconfirmed({rig.fitter, {}, kSilent, result});
  CHECK(result.effects == Names{"motor_deadband"});
  CHECK(*findParameter(result.state.model, "motor_deadband.speed") == size);
  CHECK(result.record.negligible.empty());
}

TEST_CASE("an effect that rows show far beyond chance stays though no execution tells of it") {
  Drive drive = syntheticDrive(samples::vehicleWith({{"motor_deadband.speed", 0.1}}), 200.0, 2);
  drive.executions.clear();
  const Observations data({drive}, {});
  const Fitter fitter(data);
  FoundTerms result;
  result.calibrated = fitter.start(syntheticVehicle(), {});
  result.state = result.calibrated;
  fitter.add(result.state, freeParameter(syntheticVehicle(), "motor_deadband.speed"), 0.05);
  fitter.fit(result.state);
  fitter.renewNoise(result.state);
  result.effects = {"motor_deadband"};
  dropUnconfirmed({fitter, {}, kSilent, result});
  CHECK(result.effects == Names{"motor_deadband"});
}

TEST_CASE("an effect that only bends the model away from the drive goes, and is named") {
  const Rig rig({}, 200.0, 2);
  FoundTerms result = resultOf(rig, {});
  result.state = rig.fitted({{"yaw_pull.pull", 0.01}});
  // Held far off, so that no fit of half of the driving returns to it.
  result.state.free[0].expected = 0.1;
  result.state.free[0].deviation = 1e-4;
  *findParameter(result.state.model, "yaw_pull.pull") = 0.1;
  result.effects = {"yaw_pull"};
  const FoundTerms begin = result;
  Names said;
  const Progress hear = [&said](const std::string& line) { said.push_back(line); };
  dropUnconfirmed({rig.fitter, {}, hear, result});
  CHECK(result.effects.empty());
  CHECK(result.record.negligible == Names{"yaw_pull"});
  CHECK(*findParameter(result.state.model, "yaw_pull.pull") == 0.0);
  REQUIRE(said.size() == 1);
  CHECK(said[0].find("yaw_pull: does not lessen the end error") != std::string::npos);
  FoundTerms kept = begin;
  SearchSettings settings;
  settings.accepted = {"yaw_pull"};
  dropUnconfirmed({rig.fitter, settings, kSilent, kept});
  CHECK(kept.effects == Names{"yaw_pull"});
}

TEST_CASE("an effect that each half of the driving sizes the other way is not confirmed") {
  std::vector<Drive> drives(1);
  for (size_t block = 0; block < 10; ++block) {
    const double pull = block % 2 == 0 ? 0.1 : -0.1;
    Drive part = syntheticDrive(samples::vehicleWith({{"yaw_pull.pull", pull}}), 20.0, block + 1);
    drives[0].segments.push_back(part.segments[0]);
    for (Execution execution : part.executions)
      drives[0].executions.push_back({block, execution.begin, execution.end});
  }
  const Observations data(drives, {});
  REQUIRE(data.blocks() == 10);
  const Fitter fitter(data);
  FoundTerms result;
  result.calibrated = fitter.start(syntheticVehicle(), {});
  result.state = result.calibrated;
  fitter.add(result.state, freeParameter(result.state.model, "yaw_pull.pull"), 0.01);
  result.effects = {"yaw_pull"};
  for (int half : {0, 1}) {
    const FitState own = refitted(fitter.onRows(halfMask(data, half)), result);
    CHECK(*findParameter(own.model, "yaw_pull.pull") ==
          Approx(half == 0 ? 0.1 : -0.1).margin(0.03));
  }
  dropUnconfirmed({fitter, {}, kSilent, result});
  CHECK(result.effects.empty());
}

TEST_CASE("a bias of the gyro moves no pose, and is confirmed by the yaw rate") {
  const Rig rig({{"gyro_bias.rate", 0.03}}, 200.0, 3);
  FoundTerms result = resultOf(rig, {{"gyro_bias.rate", 0.01}});
  dropUnconfirmed({rig.fitter, {}, kSilent, result});
  CHECK(result.effects == Names{"gyro_bias"});
}

TEST_CASE("without effects there is nothing to confirm") {
  const Rig rig({}, 60.0, 1);
  FoundTerms result = resultOf(rig, {});
  const Eigen::VectorXd predicted = result.state.predicted;
  dropUnconfirmed({rig.fitter, {}, [](const std::string&) { FAIL("said"); }, result});
  CHECK(result.state.predicted == predicted);
  CHECK(result.record.negligible.empty());
}

TEST_CASE("a structure is refitted on other rows with its own values to begin at") {
  const Rig rig({{"motor_deadband.speed", 0.1}}, 200.0, 2);
  const FoundTerms result = resultOf(rig, {{"motor_deadband.speed", 0.05}});
  const double whole = *findParameter(result.state.model, "motor_deadband.speed");
  for (int half : {0, 1}) {
    const FitState state = refitted(rig.fitter.onRows(halfMask(rig.data, half)), result);
    REQUIRE(state.free.size() == 1);
    const double size = *findParameter(state.model, "motor_deadband.speed");
    CHECK(size == Approx(whole).margin(0.02));
    CHECK(size != whole);
  }
}

TEST_CASE("an effect that is a free number of the model is not taken in beside it") {
  const Rig rig({}, 100.0, 1);
  FitState state = rig.fitter.start(syntheticVehicle(), givenParameters(syntheticVehicle(), true));
  rig.fitter.fit(state);
  const size_t free = state.free.size();
  const double loss = state.loss;
  CHECK(takeIn(rig.fitter, state, "actuator_lag") ==
        "it is a number of the nominal model, which is free");
  CHECK(state.free.size() == free);
  CHECK(state.loss == loss);
}

TEST_CASE(
    "what is taken in comes with its size, and effects that are switched off leave no trace") {
  const Rig rig({{"slip_ratio.slip", 0.1}}, 100.0, 1);
  const FitState nominal = rig.fitted({});
  FitState state = nominal;
  CHECK(takeIn(rig.fitter, state, "slip_ratio").empty());
  REQUIRE(state.free.size() == 1);
  CHECK(*findParameter(state.model, "slip_ratio.slip") == Approx(0.1).margin(0.02));
  CHECK(state.loss <
        totalLoss(rig.data.residuals(nominal.predicted), state.scales, rig.fitter.mask()));
  const FitState off = switchedOff(rig.fitter, state, {"slip_ratio"});
  CHECK(off.free.empty());
  CHECK(off.predicted == nominal.predicted);
  const FitState same = switchedOff(rig.fitter, state, {});
  CHECK(same.predicted == state.predicted);
  CHECK(same.free.size() == 1);
}

TEST_CASE("without an effect in first order the prediction loses its column times its size") {
  const Rig rig({}, 60.0, 1);
  const FitState state = rig.fitted({{"slip_ratio.slip", 0.05}, {"yaw_pull.pull", 0.02}});
  const FitState reduced = withoutLinearly(rig.fitter, state, "slip_ratio");
  REQUIRE(reduced.free.size() == 1);
  CHECK(reduced.free[0].path == "yaw_pull.pull");
  const Eigen::VectorXd expected =
      state.predicted - state.jacobian.col(0) * *findParameter(state.model, "slip_ratio.slip");
  CHECK((reduced.predicted - expected).norm() < 1e-12);
  CHECK(*findParameter(reduced.model, "slip_ratio.slip") ==
        *findParameter(state.model, "slip_ratio.slip"));
}

TEST_CASE(
    "a calibration frees the numbers of the model, a model with nothing known frees nothing") {
  CHECK(givenParameters(syntheticVehicle(), false).empty());
  const std::vector<FreeParameter> all = givenParameters(syntheticVehicle(), true);
  CHECK(all.size() >= 4);
  for (const FreeParameter& parameter : all) {
    CHECK(parameter.path.find('.') == std::string::npos);
    CHECK(std::isinf(parameter.deviation));
  }
  ModelDocument known = samples::vehicleWith({{"slip_ratio.slip", 0.05}});
  const auto held = [&] {
    for (const FreeParameter& parameter : givenParameters(known, false))
      if (parameter.path == "slip_ratio.slip") return parameter.deviation;
    return -1.0;
  };
  CHECK(std::isinf(held()));
  known.covariance.parameters = {"slip_ratio.slip"};
  known.covariance.matrix = {{0.0004}};
  CHECK(held() == Approx(0.02));
}
