// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <catch2/catch.hpp>

#include "core_rig.hpp"
#include "modules/identification/core/discovery.hpp"
#include "modules/identification/core/voltage_witness.hpp"
#include "modules/identification/core/witness.hpp"

using namespace tread;
using namespace tread::gap;
using samples::Rig;
using samples::Values;

namespace {

constexpr double kVoltageDrive = 400.0;  // [s]
const Values kSag{{"battery_sag.per_hour", 1.8}};

/// Evidence on the hidden effect from a voltage of 25 V that falls linearly by a share.
std::optional<VoltageWitness> voltageWitnessOf(const Values& hidden, double falls) {
  Rig rig(hidden, kVoltageDrive, 3);
  for (double time = 0.0; time < kVoltageDrive; time += 0.05)
    rig.drives.front().voltage.push_back({time, 25.0 * (1.0 - falls * time / kVoltageDrive)});
  const auto said = voltageWitnesses(rig.fitter, rig.fitted(hidden), {effectOf(hidden[0].first)});
  return said.empty() ? std::nullopt : std::optional(said.begin()->second);
}

}  // namespace

TEST_CASE("a voltage that falls as much as the motion says that it is the battery") {
  const auto voltage = voltageWitnessOf(kSag, 0.2);  // 1.8 per hour are 20 % in 400 s
  REQUIRE(voltage);
  CHECK(voltage->share == Approx(1.0).margin(0.25));
  CHECK(voltage->low < voltage->share);
  CHECK(voltage->high > voltage->share);
  CHECK(voltage->saysBattery());
  CHECK_FALSE(voltage->saysOther());
}

TEST_CASE("a voltage that stays says that it is something else") {
  const auto voltage = voltageWitnessOf(kSag, 0.001);
  REQUIRE(voltage);
  CHECK(voltage->share == Approx(0.0).margin(0.05));
  CHECK(voltage->saysOther());
  CHECK_FALSE(voltage->saysBattery());
}

TEST_CASE("other ground from a time on is not the battery, whose voltage falls all along") {
  const auto voltage =
      voltageWitnessOf({{"terrain_change.slip_1", 0.2}, {"terrain_change.time_1", 200.0}}, 0.02);
  REQUIRE(voltage);
  CHECK(voltage->saysOther());
}

TEST_CASE("the voltage says nothing of what does not change with time, and of the INS") {
  CHECK_FALSE(voltageWitnessOf({{"rolling_resistance.speed", 0.1}}, 0.2));
  CHECK_FALSE(voltageWitnessOf({{"slip_ratio.slip", 0.2}}, 0.2));
  CHECK_FALSE(voltageWitnessOf({{"ins_latency.latency", 0.3}}, 0.2));
}

TEST_CASE("without a voltage, with NaN or with one that is stuck nothing is said") {
  Rig rig(kSag, kVoltageDrive, 3);
  const FitState state = rig.fitted(kSag);
  CHECK(voltageWitnesses(rig.fitter, state, {"battery_sag"}).empty());
  for (const double stuck : {kNotMeasured, 0.0, 25.0}) {
    rig.drives.front().voltage.clear();
    for (double time = 0.0; time < kVoltageDrive; time += 0.05)
      rig.drives.front().voltage.push_back({time, stuck});
    CHECK(voltageWitnesses(rig.fitter, state, {"battery_sag"}).empty());
  }
}

TEST_CASE("what the voltage says stands with the effect that was found") {
  Rig rig(kSag, kVoltageDrive, 3);
  for (double time = 0.0; time < kVoltageDrive; time += 0.05)
    rig.drives.front().voltage.push_back({time, time < 200.0 ? 25.0 : 24.9});
  FoundTerms result;
  result.state = rig.fitted(kSag);
  result.effects = {"battery_sag"};
  const FoundEffect effect =
      identifiedModel(rig.fitter, syntheticVehicle(), {}, result).effects.front();
  REQUIRE(effect.voltage);
  CHECK(effect.voltage->saysOther());
  CHECK_FALSE(effect.currents);
}
