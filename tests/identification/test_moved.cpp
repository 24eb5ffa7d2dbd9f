// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "core_rig.hpp"
#include "modules/identification/core/moved_terms.hpp"
#include "modules/identification/core/search_steps.hpp"

// Given terms that have changed, and effects that replace several changes.

using namespace tread;
using namespace tread::gap;
using samples::kSilent;
using samples::Rig;
using samples::Values;
using samples::vehicleWith;

namespace {

using EffectNames = std::vector<std::string>;

/// A model with these numbers and a relative uncertainty common to all.
ModelDocument sureOf(const Values& given, double share) {
  ModelDocument model = vehicleWith(given);
  const size_t size = given.size();
  model.covariance.matrix.assign(size, std::vector<double>(size, 0.0));
  for (size_t i = 0; i < size; ++i) {
    model.covariance.parameters.push_back(given[i].first);
    model.covariance.matrix[i][i] = std::pow(share * given[i].second, 2);
  }
  return model;
}

/// A finished search with these effects, all named by tests.
FoundTerms endedWith(const Rig& rig, const Values& begin, const EffectNames& effects) {
  FoundTerms result;
  result.state = rig.fitted(begin);
  result.effects = effects;
  for (const std::string& effect : effects) result.evidence[effect].p_value = 0.001;
  return result;
}

}  // namespace

TEST_CASE("what has moved is estimated without what the model says of it, and held else") {
  const Rig rig({{"delay", 0.17}}, 300.0, 2);
  const ModelDocument model = sureOf({{"delay", 0.05}, {"lag", 0.2}}, 0.1);
  FoundTerms result;
  result.state = rig.fitter.start(model, givenParameters(model, false));
  rig.fitter.fitRoughly(result.state);
  rig.fitter.renewNoise(result.state);
  rig.fitter.fit(result.state);
  const double held_back = *findParameter(result.state.model, "delay");
  SearchSettings settings;
  settings.calibrate = true;
  reestimateMoved({rig.fitter, settings, kSilent, result}, model);
  CHECK(*findParameter(result.state.model, "delay") == held_back);
  settings.calibrate = false;
  reestimateMoved({rig.fitter, settings, kSilent, result}, model);
  CHECK(*findParameter(result.state.model, "delay") == Approx(0.17).margin(0.006));
  CHECK(*findParameter(result.state.model, "delay") > held_back);
  for (const FreeParameter& parameter : result.state.free)
    CHECK(std::isinf(parameter.deviation) == (parameter.path == "delay"));
}

TEST_CASE("where the body explains a position that is late as well, it comes before the INS") {
  const Rig rig({{"body_inertia.lag", 0.06}, {"centrifugal_drift.time", 0.06}}, 300.0, 2);
  FoundTerms result =
      endedWith(rig, {{"ins_latency.latency", 0.05}, {"heading_latency.latency", -0.05}},
                {"ins_latency", "heading_latency"});
  const SearchSettings settings;
  CHECK(putVehicleFirst({rig.fitter, settings, kSilent, result}));
  CHECK(result.effects == EffectNames{"body_inertia", "centrifugal_drift"});
  CHECK(result.evidence.at("body_inertia").replaced == EffectNames{"ins_latency"});
  CHECK(*findParameter(result.state.model, "body_inertia.lag") == Approx(0.06).margin(0.02));
  CHECK(*findParameter(result.state.model, "ins_latency.latency") == 0.0);
}

TEST_CASE("what the INS does and no body does stays the INS's, and so does what a person decided") {
  const Rig rig({{"ins_latency.latency", 0.3}, {"heading_latency.latency", 0.1}}, 300.0, 2);
  FoundTerms result =
      endedWith(rig, {{"ins_latency.latency", 0.2}, {"heading_latency.latency", 0.05}},
                {"ins_latency", "heading_latency"});
  const SearchSettings settings;
  CHECK_FALSE(putVehicleFirst({rig.fitter, settings, kSilent, result}));
  SearchSettings decided;
  decided.accepted = {"ins_latency"};
  CHECK_FALSE(putVehicleFirst({rig.fitter, decided, kSilent, result}));
  CHECK(result.effects == EffectNames{"ins_latency", "heading_latency"});
}

TEST_CASE("one effect takes the place of an effect and a change that explain no more together") {
  const Rig rig({{"centrifugal_drift.time", 0.06},
                 {"body_inertia.lag", 0.2},
                 {"heading_latency.latency", 0.1}},
                300.0, 2);
  FoundTerms result = endedWith(
      rig,
      {{"ins_latency.latency", 0.05}, {"centrifugal_drift.time", 0.06}, {"body_inertia.lag", 0.2}},
      {"ins_latency"});
  for (FreeParameter& parameter : result.state.free)
    if (parameter.path == "centrifugal_drift.time") parameter.expected = 0.06;
  const SearchSettings settings;
  std::vector<MovedTerm> moved{{"centrifugal_drift.time", 0.002}};
  CHECK(replaceMoved({rig.fitter, settings, kSilent, result}, moved));
  CHECK(moved.empty());
  CHECK(result.effects == EffectNames{"heading_latency"});
  CHECK(*findParameter(result.state.model, "heading_latency.latency") == Approx(0.1).margin(0.02));
  CHECK(*findParameter(result.state.model, "centrifugal_drift.time") == Approx(0.06).margin(0.006));
  SECTION("the term that the model has cannot stand for what turned out to be late") {
    noteToldFrom({rig.fitter, settings, kSilent, result});
    CHECK(result.evidence.at("heading_latency").told_from == EffectNames{"centrifugal_drift"});
  }
}

TEST_CASE("a resistance that wheels show is a deadband of their drive") {
  CHECK(effectNamed("rolling_resistance").search.in_wheels == EffectNames{"motor_deadband"});
}
