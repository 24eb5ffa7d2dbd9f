// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "core_rig.hpp"
#include "modules/identification/core/adequacy.hpp"
#include "modules/identification/core/discovery.hpp"
#include "modules/identification/core/screening.hpp"
#include "modules/identification/core/variables.hpp"

// Further stages: change points, and the test of the residuals.

using namespace tread;
using namespace tread::gap;
using samples::blockNoise;
using samples::Rig;

TEST_CASE("the moment of a change is found from seconds away, and its interval holds the truth") {
  const Rig rig({{"terrain_change.width_1", 0.3}, {"terrain_change.time_1", 133.0}}, 240.0, 1);
  const std::string path = "terrain_change.time_1";
  ModelDocument model = syntheticVehicle();
  *findParameter(model, path) = 100.0;
  FitState state = rig.fitter.start(model, {});
  const double before = state.loss;
  rig.fitter.add(state, freeParameter(model, "terrain_change.width_1"), 0.2);
  CHECK(changePointsOn(state.model) == std::vector<std::string>{path});
  rig.fitter.fitRoughly(state);
  refineChangePoint(rig.fitter, state, path);
  rig.fitter.fit(state);
  CHECK(*findParameter(state.model, path) == Approx(133.0).margin(2.0));
  CHECK(*findParameter(state.model, "terrain_change.width_1") == Approx(0.3).margin(0.03));
  CHECK(state.loss < before);
  const auto [low, high] = changePointInterval(rig.fitter, state, path, 10.0);
  CHECK(low < 133.0);
  CHECK(133.0 < high);
  CHECK(high - low < 20.0);
}

TEST_CASE("a change lies between the last execution without it and the first one with it") {
  Drive drive = syntheticDrive(
      samples::vehicleWith({{"terrain_change.width_1", 0.3}, {"terrain_change.time_1", 133.0}}),
      240.0, 1);
  // No measurements from 120 s to 140 s.
  auto& ins = drive.segments.front().ins;
  ins.erase(std::remove_if(
                ins.begin(), ins.end(),
                [](const InsSample& sample) { return sample.time > 120.0 && sample.time < 140.0; }),
            ins.end());
  const std::vector<Drive> drives{drive};
  const Observations data(drives, {});
  const Fitter fitter(data);
  const std::string path = "terrain_change.time_1";
  ModelDocument model = syntheticVehicle();
  *findParameter(model, path) = 110.0;
  FitState state = fitter.start(model, {});
  fitter.add(state, freeParameter(model, "terrain_change.width_1"), 0.2);
  fitter.fitRoughly(state);
  refineChangePoint(fitter, state, path);
  fitter.fit(state);
  const auto [low, high] = changePointInterval(fitter, state, path, 10.0);
  CHECK(low <= 121.0);
  CHECK(low > 100.0);
  CHECK(high >= 139.0);
  CHECK(high < 160.0);
}

TEST_CASE("a model without a change has no moments, and one with two has both") {
  ModelDocument model = syntheticVehicle();
  CHECK(changePointsOn(model).empty());
  *findParameter(model, "payload_change.time") = 50.0;
  CHECK(changePointsOn(model).empty());  // change point of an inactive effect
  *findParameter(model, "payload_change.speed") = 0.1;
  *findParameter(model, "terrain_change.slip_2") = 0.1;
  CHECK(changePointsOn(model) ==
        std::vector<std::string>{"terrain_change.time_2", "payload_change.time"});
}

TEST_CASE("noise that blocks have in common leaves nothing unexplained more often than alpha says",
          "[study]") {
  const Rig rig({}, 300.0, 1);
  constexpr double kAlpha = 0.05;
  int false_alarms = 0;
  for (uint64_t seed = 1; seed <= 60; ++seed) {
    const FitState state = rig.stateOf(blockNoise(rig.data, seed), 1.0);
    const Adequacy adequacy = testAdequacy(rig.fitter, state, kAlpha, seed);
    CHECK((adequacy.p_value <= kAlpha) == !adequacy.unexplained.empty());
    false_alarms += adequacy.p_value <= kAlpha;
  }
  CHECK(false_alarms <= 11);  // 4.5 are expected; 1 of 500 correct tests has more than 11
}

TEST_CASE("what is left is likened to the effect that looks like it in its channel") {
  const Rig rig({{"centrifugal_drift.time", 0.3}}, 300.0, 2);
  const Adequacy adequacy = testAdequacy(rig.fitter, rig.fitted({}), 0.01, 2);
  REQUIRE_FALSE(adequacy.unexplained.empty());
  CHECK(adequacy.unexplained[0].channel == "lateral");
  const std::string& like = adequacy.unexplained[0].like;
  CHECK((like == "centrifugal_drift" || like == "heading_latency"));  // the same form
}

TEST_CASE("what no effect explains is named by its channel and by what it depends on") {
  const Rig rig({}, 300.0, 2);
  const ModelDocument model = syntheticVehicle();
  const std::vector<Variable> variables = variablesOf(rig.data, model);
  const auto squared = std::find_if(variables.begin(), variables.end(),
                                    [](const Variable& v) { return v.name == "v x yaw rate"; });
  REQUIRE(squared != variables.end());
  Eigen::VectorXd residuals = blockNoise(rig.data, 2);
  for (size_t i = 0; i < rig.data.all().size(); ++i)
    if (rig.data.all()[i].channel == ObservedRate::kAcross)
      residuals[static_cast<Eigen::Index>(i)] +=
          4.0 * squared->values[static_cast<Eigen::Index>(i)];
  const Adequacy adequacy = testAdequacy(rig.fitter, rig.stateOf(residuals, 1.0), 0.01, 2);
  CHECK(adequacy.p_value <= 0.01);
  REQUIRE_FALSE(adequacy.unexplained.empty());
  CHECK(adequacy.unexplained[0].channel == "lateral");
  CHECK(adequacy.unexplained[0].variable.find("yaw rate") != std::string::npos);
  for (const Unexplained& rest : adequacy.unexplained) CHECK(rest.channel == "lateral");
}
