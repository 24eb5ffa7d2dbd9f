// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "core_rig.hpp"
#include "modules/identification/core/lag_structure.hpp"
#include "modules/identification/core/pruning.hpp"
#include "modules/identification/core/search_steps.hpp"

using namespace tread;
using namespace tread::gap;
using samples::Rig;
using samples::Values;

namespace {

using Names = std::vector<std::string>;

using samples::kSilent;
const Needed kNeeded{3.0, 1.0};

/// A finished search with these initial parameters.
FoundTerms searchedWith(const Rig& rig, const Values& begin) {
  FoundTerms result;
  result.state = rig.fitted(begin);
  for (const auto& [path, value] : begin) {
    const std::string effect = path.substr(0, path.find('.'));
    result.effects.push_back(effect);
    result.evidence[effect].p_value = 0.001;
  }
  return result;
}

FoundTerms pruned(const Rig& rig, FoundTerms result, const SearchSettings& settings = {}) {
  pruneEffects({rig.fitter, settings, kSilent, result}, kNeeded);
  return result;
}

}  // namespace

TEST_CASE("a superfluous effect goes, with a step that says why, and a real one stays") {
  const Rig rig({{"motor_deadband.speed", 0.1}}, 300.0, 2);
  const FoundTerms result =
      pruned(rig, searchedWith(rig, {{"motor_deadband.speed", 0.05}, {"yaw_pull.pull", 0.01}}));
  CHECK(result.effects == Names{"motor_deadband"});
  CHECK(result.state.free.size() == 1);
  CHECK(*findParameter(result.state.model, "yaw_pull.pull") == 0.0);
  CHECK(*findParameter(result.state.model, "motor_deadband.speed") == Approx(0.1).margin(0.01));
  CHECK(result.evidence.at("motor_deadband").score > kNeeded.score);
  CHECK(result.evidence.at("motor_deadband").gain.value > 0.0);
  REQUIRE(result.record.steps.size() == 1);
  CHECK(result.record.steps[0].effect == "yaw_pull");
  CHECK(result.record.steps[0].removed);
  CHECK(result.record.steps[0].remark == "chance explains it in the presence of the others");
  CHECK(result.record.negligible.empty());
}

TEST_CASE("an accepted effect stays though it is superfluous, and its numbers are told") {
  const Rig rig({{"motor_deadband.speed", 0.1}}, 300.0, 2);
  FoundTerms begin = searchedWith(rig, {{"motor_deadband.speed", 0.05}, {"yaw_pull.pull", 0.01}});
  SearchSettings settings;
  settings.accepted = {"yaw_pull"};
  const FoundTerms result = pruned(rig, begin, settings);
  CHECK(result.effects == Names{"motor_deadband", "yaw_pull"});
  CHECK(result.record.steps.empty());
  CHECK(std::abs(result.evidence.at("yaw_pull").score) < kNeeded.score);
}

TEST_CASE("a plain cause that was only a nuisance term goes without a word") {
  const Rig rig({{"motor_deadband.speed", 0.1}}, 300.0, 2);
  FoundTerms covered = searchedWith(rig, {{"motor_deadband.speed", 0.05}, {"yaw_pull.pull", 0.01}});
  covered.evidence["yaw_pull"].p_value.reset();
  const FoundTerms result = pruned(rig, covered);
  CHECK(result.effects == Names{"motor_deadband"});
  CHECK(result.record.steps.empty());
}

TEST_CASE("an effect that is real but does not change where drives end is negligible") {
  SyntheticNoise noise;
  noise.gyro = 0.002;
  const Rig rig({{"gyro_bias.rate", 0.002}}, 300.0, 3, noise);
  const FoundTerms begin = searchedWith(rig, {{"gyro_bias.rate", 0.001}});
  const FoundTerms result = pruned(rig, begin);
  CHECK(result.effects.empty());
  CHECK(result.record.negligible == Names{"gyro_bias"});
  FoundTerms kept = begin;
  SearchSettings small;
  small.least_gain = 0.0;
  pruneEffects({rig.fitter, small, kSilent, kept}, kNeeded);
  CHECK(kept.effects == Names{"gyro_bias"});
}

TEST_CASE("an effect that runs to the end of its plausible range goes, for that reason") {
  const Rig rig({{"motor_deadband.speed", 0.1}}, 300.0, 2);
  FoundTerms begin;
  ModelDocument model = syntheticVehicle();
  model.bounds.push_back({"motor_deadband.speed", 0.0, 0.05});
  begin.state = rig.fitter.start(model, {});
  rig.fitter.add(begin.state, freeParameter(model, "motor_deadband.speed"), 0.02);
  rig.fitter.fit(begin.state);
  begin.effects = {"motor_deadband"};
  begin.evidence["motor_deadband"].p_value = 0.001;
  const FoundTerms result = pruned(rig, begin);
  CHECK(result.effects.empty());
  REQUIRE(result.record.steps.size() == 1);
  CHECK(result.record.steps[0].remark == "runs to the end of its plausible range");
  SearchSettings settings;
  settings.accepted = {"motor_deadband"};
  CHECK(pruned(rig, begin, settings).effects == Names{"motor_deadband"});
}

TEST_CASE("without an effect the others are fitted anew, and the loss tells what it was worth") {
  const Rig rig({{"motor_deadband.speed", 0.1}}, 240.0, 4);
  const FitState with = rig.fitted({{"motor_deadband.speed", 0.05}, {"slip_ratio.slip", 0.01}});
  const FitState reduced = without(rig.fitter, with, "motor_deadband");
  CHECK(*findParameter(reduced.model, "motor_deadband.speed") == 0.0);
  REQUIRE(reduced.free.size() == 1);
  CHECK(reduced.free[0].path == "slip_ratio.slip");
  CHECK(reduced.loss > with.loss + 10.0);
  // Slip is most similar to a deadband.
  CHECK(*findParameter(reduced.model, "slip_ratio.slip") >
        *findParameter(with.model, "slip_ratio.slip") + 0.02);
}

TEST_CASE("two effects that imitate one become that one") {
  const Rig rig({{"position_scale.scale", -0.06}}, 300.0, 5);
  FoundTerms result =
      searchedWith(rig, {{"slip_ratio.slip", 0.05}, {"track_width.widening", 0.01}});
  replacePairs({rig.fitter, {}, kSilent, result});
  CHECK(result.effects == Names{"position_scale"});
  CHECK(result.evidence["position_scale"].replaced == Names{"slip_ratio", "track_width"});
  CHECK(*findParameter(result.state.model, "position_scale.scale") == Approx(-0.06).margin(0.01));
  CHECK(*findParameter(result.state.model, "slip_ratio.slip") == 0.0);
  REQUIRE(result.record.steps.size() == 1);
  CHECK(result.record.steps[0].remark.find("in the place of") == 0);
}

TEST_CASE("neither does an accepted effect go into another one, nor does a rejected one come") {
  const Rig rig({{"position_scale.scale", -0.06}}, 300.0, 5);
  const FoundTerms begin =
      searchedWith(rig, {{"slip_ratio.slip", 0.05}, {"track_width.widening", 0.01}});
  for (const bool accepted : {false, true}) {
    FoundTerms result = begin;
    SearchSettings settings;
    if (accepted)
      settings.accepted = {"track_width"};
    else
      settings.rejected = {"position_scale"};
    replacePairs({rig.fitter, settings, kSilent, result});
    CHECK(result.effects == Names{"slip_ratio", "track_width"});
  }
}

TEST_CASE("two effects that no single one fits as well stay two") {
  const Rig rig({{"slip_ratio.slip", 0.1}, {"track_width.widening", 0.25}}, 300.0, 6);
  FoundTerms result = searchedWith(rig, {{"slip_ratio.slip", 0.05}, {"track_width.widening", 0.1}});
  const double loss = result.state.loss;
  replacePairs({rig.fitter, {}, kSilent, result});
  CHECK(result.effects == Names{"slip_ratio", "track_width"});
  CHECK(result.record.steps.empty());
  CHECK(result.state.loss == loss);
}

namespace {

double valueOf(const FoundTerms& result, const std::string& path) {
  return *findParameter(result.state.model, path);
}

}  // namespace

TEST_CASE("a lag of the drive that was found for two lags, of yaw rate and speed, gives way") {
  const Rig rig({{"yaw_inertia.lag", 0.8}, {"body_inertia.lag", 0.3}}, 400.0, 5);
  FoundTerms result = searchedWith(rig, {{"actuator_lag.lag", 0.4}});
  REQUIRE(chooseLags({rig.fitter, {}, kSilent, result}));
  CHECK(result.effects == Names{"yaw_inertia", "body_inertia"});
  CHECK(valueOf(result, "actuator_lag.lag") == 0.0);
  CHECK(valueOf(result, "yaw_inertia.lag") == Approx(0.8).margin(0.05));
  CHECK(valueOf(result, "body_inertia.lag") == Approx(0.3).margin(0.05));
  REQUIRE(result.record.steps.size() == 3);
  CHECK(result.record.steps[0].effect == "actuator_lag");
  CHECK(result.record.steps[0].removed);
  CHECK(result.record.steps[1].remark == "the lags together: yaw_inertia and body_inertia");
  CHECK_FALSE(chooseLags({rig.fitter, {}, kSilent, result}));
}

TEST_CASE("two lags, of yaw rate and speed, that are one lag of the drive are told once") {
  const Rig rig({{"actuator_lag.lag", 0.5}}, 400.0, 6);
  FoundTerms result = searchedWith(rig, {{"yaw_inertia.lag", 0.5}, {"body_inertia.lag", 0.4}});
  REQUIRE(chooseLags({rig.fitter, {}, kSilent, result}));
  CHECK(result.effects == Names{"actuator_lag"});
  CHECK(valueOf(result, "actuator_lag.lag") == Approx(0.5).margin(0.05));
}

TEST_CASE("lags that a person or the model decided on are not chosen anew") {
  const Rig rig({{"yaw_inertia.lag", 0.8}, {"body_inertia.lag", 0.3}}, 300.0, 5);
  FoundTerms result = searchedWith(rig, {{"actuator_lag.lag", 0.4}});
  SearchSettings settings;
  settings.accepted = {"actuator_lag"};
  CHECK_FALSE(chooseLags({rig.fitter, settings, kSilent, result}));
  settings.accepted = {};
  settings.rejected = {"yaw_inertia"};
  CHECK_FALSE(chooseLags({rig.fitter, settings, kSilent, result}));
  FoundTerms given = searchedWith(rig, {{"yaw_inertia.lag", 0.5}, {"actuator_lag.lag", 0.4}});
  given.effects = {"actuator_lag"};
  CHECK_FALSE(chooseLags({rig.fitter, {}, kSilent, given}));
}

TEST_CASE("a delay too small to matter by itself stays beside a long lag, whose size it bears") {
  SearchSettings settings;
  settings.least_gain = 0.2;
  const Rig alone({{"command_delay.delay", 0.02}}, 300.0, 7);
  const FoundTerms small =
      pruned(alone, searchedWith(alone, {{"command_delay.delay", 0.01}}), settings);
  CHECK(small.record.negligible == Names{"command_delay"});
  const Rig beside({{"command_delay.delay", 0.02}, {"actuator_lag.lag", 0.5}}, 300.0, 7);
  const FoundTerms both = pruned(
      beside, searchedWith(beside, {{"command_delay.delay", 0.01}, {"actuator_lag.lag", 0.4}}),
      settings);
  CHECK(both.effects == Names{"command_delay", "actuator_lag"});
}

TEST_CASE("where the model's own lag is calibrated, it may turn out to be two, too") {
  const Rig rig({{"lag", 0.0}, {"yaw_inertia.lag", 0.8}, {"body_inertia.lag", 0.3}}, 400.0, 5);
  FoundTerms result;
  result.state = rig.fitter.start(syntheticVehicle(), givenParameters(syntheticVehicle(), true));
  rig.fitter.fit(result.state);
  REQUIRE(valueOf(result, "lag") > 0.3);
  REQUIRE(chooseLags({rig.fitter, {}, kSilent, result}));
  CHECK(result.effects == Names{"yaw_inertia", "body_inertia"});
  CHECK(valueOf(result, "yaw_inertia.lag") == Approx(0.8).margin(0.1));
  CHECK(valueOf(result, "body_inertia.lag") == Approx(0.3).margin(0.1));
  CHECK(valueOf(result, "lag") == Approx(0.0).margin(0.1));
}

TEST_CASE("a lag of the drive that a calibrated model has beside its own stays") {
  const Rig rig({{"yaw_inertia.lag", 0.8}, {"body_inertia.lag", 0.3}}, 300.0, 5);
  ModelDocument model = syntheticVehicle();
  *findParameter(model, "actuator_lag.lag") = 0.2;
  FoundTerms result;
  result.state = rig.fitter.start(model, givenParameters(model, true));
  rig.fitter.fit(result.state);
  CHECK_FALSE(chooseLags({rig.fitter, {}, kSilent, result}));
  CHECK(valueOf(result, "actuator_lag.lag") != 0.0);
}
