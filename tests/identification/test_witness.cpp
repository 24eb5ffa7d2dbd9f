// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "core_rig.hpp"
#include "modules/identification/core/discovery.hpp"
#include "modules/identification/core/witness.hpp"

using namespace tread;
using namespace tread::gap;
using samples::encodersOf;
using samples::Rig;
using samples::Values;

namespace {

/// Evidence of wheels that follow the tracks of `tracks`, for the effects hidden in a drive, in
/// order.
std::vector<std::optional<WheelWitness>> witnessesOf(const Values& hidden, const Values& tracks,
                                                     double late = 0.0) {
  Rig rig(hidden, 400.0, 3);
  rig.drives.front().encoders = encodersOf(samples::vehicleWith(tracks), rig.drives.front(), late);
  std::vector<std::string> names;
  for (const auto& [path, value] : hidden) names.push_back(effectOf(path));
  const auto said = wheelWitnesses(rig.fitter, rig.fitted(hidden), names);
  std::vector<std::optional<WheelWitness>> witnesses;
  for (const std::string& name : names) {
    const auto one = said.find(name);
    witnesses.push_back(one == said.end() ? std::nullopt : std::optional(one->second));
  }
  return witnesses;
}

std::optional<WheelWitness> witnessOf(const Values& hidden, const Values& tracks,
                                      double late = 0.0) {
  return witnessesOf(hidden, tracks, late).front();
}

}  // namespace

TEST_CASE("of an effect in the drive the wheel speeds show all, whatever the wheels' scale") {
  const Values limit{{"speed_saturation.inverse_limit", 1.4}};
  const auto wheels = witnessOf(limit, limit);
  REQUIRE(wheels);
  CHECK(wheels->share == Approx(1.0).margin(0.1));
  CHECK(wheels->low < wheels->share);
  CHECK(wheels->high > wheels->share);
  CHECK(wheels->saysDrive());
  CHECK_FALSE(wheels->saysGround());
}

TEST_CASE("of an effect under the wheels they show nothing") {
  const auto wheels = witnessOf({{"yaw_inertia.lag", 0.8}}, {});
  REQUIRE(wheels);
  CHECK(wheels->share == Approx(0.0).margin(0.1));
  CHECK(wheels->saysGround());
  CHECK_FALSE(wheels->saysDrive());
}

TEST_CASE("a lag that the wheels have, too, is in the drive, also where encoders are late") {
  const Values lag{{"actuator_lag.lag", 0.6}};
  for (const double late : {0.0, 0.125}) {
    const auto wheels = witnessOf(lag, lag, late);
    REQUIRE(wheels);
    CHECK(wheels->share > 0.9);
    CHECK(wheels->share < 1.4);
    CHECK(wheels->saysDrive());
  }
}

TEST_CASE("a lag in the drive beside one under the wheels: together they are in neither") {
  const Values drive{{"actuator_lag.lag", 0.4}};
  const auto both = witnessesOf({{"actuator_lag.lag", 0.4}, {"yaw_inertia.lag", 0.6}}, drive);
  for (const auto& wheels : both) {
    if (!wheels) continue;  // too vague to decide
    CHECK(wheels->of_lags);
    CHECK(wheels->share > 0.1);
    CHECK(wheels->share < 0.9);
  }
}

TEST_CASE("an effect in the drive beside one under the wheels: each is told for itself") {
  const Values limit{{"speed_saturation.inverse_limit", 1.4}};
  const auto wheels =
      witnessesOf({{"speed_saturation.inverse_limit", 1.4}, {"yaw_inertia.lag", 0.8}}, limit);
  REQUIRE(wheels[0]);
  REQUIRE(wheels[1]);
  CHECK(wheels[0]->share == Approx(1.0).margin(0.15));
  CHECK(wheels[0]->saysDrive());
  CHECK(wheels[1]->share == Approx(0.0).margin(0.15));
  CHECK(wheels[1]->saysGround());
  CHECK_FALSE(wheels[1]->of_lags);
}

TEST_CASE(
    "wheel speeds say nothing of scales, of motion to the side, of the INS, and without any") {
  CHECK_FALSE(witnessOf({{"slip_ratio.slip", 0.2}}, {}));
  CHECK_FALSE(witnessOf({{"centrifugal_drift.time", 0.2}}, {}));
  CHECK_FALSE(witnessOf({{"ins_latency.latency", 0.3}}, {}));
  const Rig rig({{"yaw_inertia.lag", 0.8}}, 300.0, 3);
  CHECK(
      wheelWitnesses(rig.fitter, rig.fitted({{"yaw_inertia.lag", 0.8}}), {"yaw_inertia"}).empty());
}

TEST_CASE("a delay that the wheels have is no latency of the INS any more") {
  const Values delay{{"command_delay.delay", 0.4}};
  Rig rig(delay, 400.0, 3);
  const auto found = [&] {
    FoundTerms result;
    result.state = rig.fitted(delay);
    result.effects = {"command_delay"};
    return identifiedModel(rig.fitter, syntheticVehicle(), {}, result).effects.front();
  };
  CHECK(found().group == std::vector<std::string>{"ins_latency"});
  rig.drives.front().encoders = encodersOf(samples::vehicleWith(delay), rig.drives.front());
  REQUIRE(found().wheels);
  CHECK(found().wheels->saysDrive());
  CHECK(found().group.empty());
}

TEST_CASE("encoders that are late themselves do not make a short latency of the INS a delay") {
  const Values delay{{"command_delay.delay", 0.12}};
  Rig rig(delay, 400.0, 3);
  // The tracks have no delay; the encoders are late by as much.
  rig.drives.front().encoders = encodersOf(samples::vehicleWith({}), rig.drives.front(), 0.12);
  FoundTerms result;
  result.state = rig.fitted(delay);
  result.effects = {"command_delay"};
  const FoundEffect effect =
      identifiedModel(rig.fitter, syntheticVehicle(), {}, result).effects.front();
  CHECK(effect.group == std::vector<std::string>{"ins_latency"});
}

TEST_CASE("of two effects that resemble each other wheels say one thing, or nothing") {
  // A drive turns to one side by an asymmetry that the wheels show completely, and by a pull.
  const Values both{{"track_asymmetry.share", 0.05}, {"yaw_pull.pull", 0.05}};
  for (const auto& said : witnessesOf(both, {{"track_asymmetry.share", 0.05}})) CHECK_FALSE(said);
  // If the wheels show everything there is no contradiction.
  const auto alone =
      witnessOf({{"track_asymmetry.share", 0.05}}, {{"track_asymmetry.share", 0.05}});
  REQUIRE(alone);
  CHECK(alone->saysDrive());
}
