// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "core_rig.hpp"
#include "modules/identification/core/discovery.hpp"
#include "modules/identification/core/search_steps.hpp"

using namespace tread;
using namespace tread::gap;
using samples::Rig;
using samples::Values;
using samples::vehicleWith;

namespace {

using Names = std::vector<std::string>;

GapFinding findWith(const Values& hidden, const std::vector<EffectDecision>& decisions) {
  GapTask task;
  task.model = syntheticVehicle();
  task.train.push_back(syntheticDrive(vehicleWith(hidden), 300.0, 6));
  task.decisions = decisions;
  return findGap(task, [](const std::string&) {});
}

Names namesIn(const GapFinding& finding) {
  Names names;
  for (const FoundEffect& effect : finding.identified.effects) names.push_back(effect.name);
  return names;
}

}  // namespace

TEST_CASE("an accepted effect stays in the model though the drive does not show it, and says so") {
  const GapFinding finding = findWith({}, {{"yaw_pull", true, "Anna"}});
  REQUIRE(namesIn(finding) == Names{"yaw_pull"});
  CHECK(finding.identified.effects[0].accepted);
  CHECK_FALSE(isShown(finding.identified.effects[0]));
  CHECK(finding.identified.model.vehicle.effects.yaw_pull ==
        finding.identified.effects[0].parameters.at(0).value);
  CHECK(finding.identified.model.vehicle.effects.yaw_pull != 0.0);
  CHECK(finding.verdict == GapVerdict::kNoDiscrepancy);
  REQUIRE(finding.source.decisions.size() == 1);
  CHECK(finding.source.decisions[0].by == "Anna");
}

TEST_CASE("an accepted effect that is there is sized, shown, and others are found beside it") {
  const GapFinding finding =
      findWith({{"track_asymmetry.share", 0.05}, {"centrifugal_drift.time", 0.2}},
               {{"track_asymmetry", true, ""}});
  const Names names = namesIn(finding);
  REQUIRE(names.size() >= 2);
  CHECK(names[0] == "track_asymmetry");
  CHECK(std::count(names.begin(), names.end(), "centrifugal_drift") == 1);
  CHECK(isShown(finding.identified.effects[0]));
  CHECK(finding.identified.effects[0].parameters.at(0).value == Approx(0.05).margin(0.01));
}

TEST_CASE("a rejected effect is not considered: neither found nor among the candidates") {
  const GapFinding finding =
      findWith({{"motor_deadband.speed", 0.1}}, {{"motor_deadband", false, ""}});
  const Names names = namesIn(finding);
  CHECK(std::count(names.begin(), names.end(), "motor_deadband") == 0);
  for (const CandidateTest& test : finding.search.candidates)
    CHECK(test.effect != "motor_deadband");
  CHECK(finding.identified.model.vehicle.effects.motor_deadband == 0.0);
}

TEST_CASE("a rejected plain cause is no nuisance term either") {
  const GapFinding finding = findWith({{"slip_ratio.slip", 0.1}}, {{"slip_ratio", false, ""}});
  const Names names = namesIn(finding);
  CHECK(std::count(names.begin(), names.end(), "slip_ratio") == 0);
  CHECK(finding.identified.model.vehicle.effects.slip_ratio == 0.0);
}

TEST_CASE("of two effects that no drive tells apart a decision names the one") {
  const Values hidden{{"icr_offset.offset", 0.1}};
  const GapFinding rejected = findWith(hidden, {{"lever_arm_x", false, ""}});
  CHECK(rejected.verdict == GapVerdict::kFound);
  REQUIRE(namesIn(rejected) == Names{"icr_offset"});
  CHECK(rejected.identified.effects[0].group.empty());
  const GapFinding accepted = findWith(hidden, {{"lever_arm_x", true, ""}});
  CHECK(accepted.verdict == GapVerdict::kMeasurement);
  CHECK(namesIn(accepted) == Names{"lever_arm_x"});
}

TEST_CASE("an effect under its second name can be accepted, too") {
  const GapFinding finding =
      findWith({{"heading_misalignment.angle", 0.05}}, {{"crab", true, "Ben"}});
  CHECK(namesIn(finding) == Names{"crab"});
}

TEST_CASE("what the drive cannot size cannot be accepted, and one line says why") {
  const auto refused = [](const Values& hidden, const std::vector<EffectDecision>& decisions) {
    try {
      findWith(hidden, decisions);
    } catch (const std::invalid_argument& error) {
      return std::string(error.what());
    }
    return std::string();
  };
  CHECK(refused({}, {{"motor_deadband", true, ""}}).find("motor_deadband: accepted, but") == 0);
  CHECK(refused({{"icr_offset.offset", 0.1}}, {{"icr_offset", true, ""}, {"lever_arm_x", true, ""}})
            .find("lever_arm_x: accepted, but") == 0);
}

TEST_CASE("an effect is taken in with its size, from the most promising of its change points") {
  const Rig rig({{"terrain_change.width_1", 0.3}, {"terrain_change.time_1", 133.0}}, 240.0, 1);
  FitState state = rig.fitted({});
  CHECK(takeIn(rig.fitter, state, "terrain_change").empty());
  CHECK(*findParameter(state.model, "terrain_change.width_1") == Approx(0.3).margin(0.03));
  CHECK(*findParameter(state.model, "terrain_change.time_1") == Approx(133.0).margin(2.0));
}

TEST_CASE("an effect that nothing excites leaves the state as it was") {
  Rig rig({}, 200.0, 1);
  for (InsSample& sample : rig.drives[0].segments[0].ins) sample.pitch = 0.0;
  const Observations level(rig.drives, {});
  const Fitter fitter(level);
  FitState state = fitter.start(syntheticVehicle(), {});
  const double loss = state.loss;
  CHECK_FALSE(takeIn(fitter, state, "slope_pitch").empty());
  CHECK(state.free.empty());
  CHECK(state.loss == loss);
}
