// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <cmath>

#include <catch2/catch.hpp>

#include "core_rig.hpp"
#include "modules/identification/core/discovery.hpp"
#include "modules/identification/core/rest.hpp"
#include "nameless_drive.hpp"

// Old and new residuals: a model stores what it did not explain when it was made.

using namespace tread;
using namespace tread::gap;
using samples::kSilent;
using samples::Rig;
using samples::turningDrive;
using samples::Values;
using samples::vehicleWith;

namespace {

GapFinding findOn(const ModelDocument& model, const Drive& drive, bool calibrate = false) {
  GapTask task;
  task.model = model;
  task.train = {drive};
  task.calibrate = calibrate;
  task.named_only = true;  // otherwise a term would be added instead of a rest
  return findGap(task, kSilent);
}

}  // namespace

namespace {

constexpr double kTurns = 0.03;  // [s] about the ground's noise, and clearly significant

/// A model calibrated on a drive of that vehicle.
const GapFinding& calibrated() {
  static const GapFinding finding = findOn(syntheticVehicle(), turningDrive({}, kTurns, 1), true);
  return finding;
}

}  // namespace

TEST_CASE("what calibration leaves without a name is in the new model as its rest, with sizes") {
  const std::vector<RestTerm> rest = calibrated().identified.model.rest.value();
  CHECK(calibrated().verdict == GapVerdict::kPartial);
  CHECK_FALSE(calibrated().adequacy.unexplained.empty());
  const auto square = std::find_if(rest.begin(), rest.end(), [](const RestTerm& term) {
    return term.condition == "yaw rate^2" && term.channel == "heading rate";
  });
  REQUIRE(square != rest.end());
  CHECK(square->size == Approx(kTurns).margin(2.0 * square->deviation));
  const auto whole = std::find_if(rest.begin(), rest.end(), [](const RestTerm& term) {
    return term.condition == kAllConditions && term.channel == "yaw rate";
  });
  REQUIRE(whole != rest.end());
  CHECK(whole->size > 5.0 * whole->deviation);
}

TEST_CASE("what calibration explains leaves an empty rest, and later drives no discrepancy") {
  const GapFinding first = findOn(syntheticVehicle(), turningDrive({}, 0.0, 1), true);
  REQUIRE(first.identified.model.rest);
  CHECK(first.identified.model.rest->empty());
  CHECK(findOn(first.identified.model, turningDrive({}, 0.0, 2)).verdict ==
        GapVerdict::kNoDiscrepancy);
}

TEST_CASE("a vehicle that did not change has nothing new, and its model keeps its rest") {
  const ModelDocument& model = calibrated().identified.model;
  for (uint64_t seed = 2; seed <= 4; ++seed) {
    const GapFinding again = findOn(model, turningDrive({}, kTurns, seed));
    CHECK(again.verdict == GapVerdict::kNothingNew);
    CHECK(exitStatus(again.verdict) == 0);
    CHECK(again.adequacy.unexplained.empty());
    REQUIRE(again.identified.model.rest);
    CHECK(again.identified.model.rest->size() == model.rest->size());
    CHECK(again.identified.model.rest->front().size == model.rest->front().size);
  }
}

TEST_CASE("a new effect is named beside a known rest, and nothing else is") {
  const GapFinding deadband = findOn(calibrated().identified.model,
                                     turningDrive({{"motor_deadband.speed", 0.1}}, kTurns, 8));
  CHECK(deadband.verdict == GapVerdict::kFound);
  REQUIRE(deadband.identified.effects.size() == 1);
  CHECK(deadband.identified.effects[0].name == "motor_deadband");
  CHECK(deadband.identified.effects[0].parameters[0].value == Approx(0.1).margin(0.01));
}

TEST_CASE("a number of the model that is another one now is told beside a known rest") {
  const ModelDocument& model = calibrated().identified.model;
  const double delay = 0.1 + model.vehicle.delay;
  const GapFinding later = findOn(model, turningDrive({{"delay", delay}}, kTurns, 9));
  CHECK(exitStatus(later.verdict) != 0);
  std::vector<std::string> told;
  for (const FoundEffect& effect : later.identified.effects) told.push_back(effect.name);
  for (const ParameterEstimate& estimate : later.identified.calibrated)
    if (estimate.moved) told.push_back(effectOfPath(estimate.parameter));
  CHECK(told == std::vector<std::string>{"command_delay"});
}

TEST_CASE("scores and sizes scatter by what a known rest varies, in its channel alone") {
  const Rig rig({}, 200.0, 1);
  FitState state = rig.stateOf(samples::blockNoise(rig.data, 3), 0.9);
  state.jacobian = samples::waves(rig.data, 2);
  state.free = {freeParameter(state.model, "yaw_pull.pull"),
                freeParameter(state.model, "gyro_bias.rate")};
  const Eigen::MatrixXd direction = samples::waves(rig.data, 5).rightCols(1);
  const Eigen::MatrixXd covariance = parameterCovariance(rig.fitter, state);
  const double score = ScoreTest(rig.fitter, state, direction).score(0);
  state.model.rest = {{"yaw rate", kAllConditions, 0.5, 0.01}};
  const Eigen::VectorXd variation = restVariation(rig.fitter, state);
  for (size_t row = 0; row < rig.data.all().size(); ++row) {
    const ObservedRate channel = rig.data.all()[row].channel;
    const bool turns = channel == ObservedRate::kYawRate || channel == ObservedRate::kHeading;
    REQUIRE((variation[static_cast<Eigen::Index>(row)] > 0.0) == turns);
  }
  const Eigen::MatrixXd varied = parameterCovariance(rig.fitter, state);
  CHECK(varied(0, 0) > covariance(0, 0));
  CHECK(varied(0, 1) == covariance(0, 1));  // the common part is as well known as before
  CHECK(std::abs(ScoreTest(rig.fitter, state, direction).score(0)) < std::abs(score));
}

TEST_CASE("what is new and has no name is not taken for the known rest, and is in the next one") {
  const ModelDocument& model = calibrated().identified.model;
  // Measured: half of it is found in this noise, too.
  const GapFinding slides = findOn(model, turningDrive({}, kTurns, 3, 0.02));
  CHECK(slides.verdict == GapVerdict::kNotInCatalogue);
  REQUIRE_FALSE(slides.adequacy.unexplained.empty());
  for (const Unexplained& one : slides.adequacy.unexplained) CHECK(one.channel == "lateral");
  CHECK(findOn(slides.identified.model, turningDrive({}, kTurns, 4, 0.02)).verdict ==
        GapVerdict::kNothingNew);
  // Five times the known size is no variation of it.
  CHECK(exitStatus(findOn(model, turningDrive({}, 5.0 * kTurns, 7)).verdict) != 0);
}

TEST_CASE("who calibrates anew knows of no rest") {
  const GapFinding again = findOn(calibrated().identified.model, turningDrive({}, kTurns, 2), true);
  CHECK_FALSE(again.before.rest);
  CHECK(exitStatus(again.verdict) != 0);
  CHECK_FALSE(again.adequacy.unexplained.empty());
}

TEST_CASE("a rest of what nothing tests is refused, in one line that names it") {
  const Rig rig({}, 60.0, 1);
  ModelDocument model = syntheticVehicle();
  model.rest = {{"yaw rate", "turns before", 0.1, 0.01}, {"yaw rate", kAllConditions, 0.1, 0.01}};
  const Eigen::MatrixXd conditions = restConditions(rig.data, model);
  REQUIRE(conditions.cols() == 2);
  CHECK(conditions.col(0).norm() > 0.0);
  CHECK(conditions.col(1).norm() == 0.0);
  for (size_t row = 0; row < rig.data.all().size(); ++row)
    if (rig.data.all()[row].channel != ObservedRate::kYawRate)
      REQUIRE(conditions(static_cast<Eigen::Index>(row), 0) == 0.0);
  const Fitter fitter(rig.data, serialFor, conditions);
  const std::vector<FreeParameter> sizes = restParameters(fitter, model);
  REQUIRE(sizes.size() == 1);  // a function of all conditions has no direction
  CHECK(sizes[0].expected == 0.1);
  CHECK(sizes[0].deviation == Approx(std::hypot(0.01, kRestVaries * 0.1)));
  CHECK((fitter.predict(model) - rig.fitter.predict(model)).isApprox(0.1 * conditions.col(0)));
  model.rest = {{"yaw rate", "turns befor", 0.1, 0.01}};
  CHECK_THROWS_WITH(restConditions(rig.data, model), Catch::Contains("'turns befor'"));
  model.rest = {{"yaw", "turns before", 0.1, 0.01}};
  CHECK_THROWS_WITH(restConditions(rig.data, model), Catch::Contains("'yaw'"));
}
