// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Properties of every entry of the catalogue.
#include <set>
#include <string>
#include <vector>

#include <catch2/catch.hpp>

#include "common/vehicle/effects.hpp"
#include "common/vehicle/model_document.hpp"
#include "tests/common/vehicle/rich_drive.hpp"

using namespace tread;

namespace {

const std::vector<std::string> kVehicleNames{
    "slip_ratio",        "track_asymmetry",    "track_width",        "yaw_rate_skid",
    "turn_power_limit",  "yaw_breakaway",      "speed_understeer",   "yaw_pull",
    "motor_deadband",    "speed_saturation",   "actuator_lag",       "command_delay",
    "slew_limit",        "lag_asymmetry",      "battery_sag",        "thermal_derating",
    "payload_change",    "slope_pitch",        "slope_roll",         "terrain_change",
    "centrifugal_drift", "grip_limit",         "rolling_resistance", "quadratic_drag",
    "turn_speed_loss",   "reverse_speed_gain", "reverse_yaw_gain",   "icr_offset",
    "yaw_inertia",       "body_inertia",       "track_backlash",     "crab",
    "yaw_rate_offset"};
const std::vector<std::string> kMeasurementNames{
    "ins_latency", "heading_latency", "gyro_bias",     "heading_misalignment",
    "lever_arm_x", "lever_arm_y",     "position_scale"};

/// A value for the rich drive of 18 s below 2 m/s; catalogue values are for whole sessions.
double valueFor(const EffectParameter& parameter) {
  if (parameter.vehicle == &EffectValues::battery_sag_per_hour) return 6.0;
  if (parameter.vehicle == &EffectValues::grip_limit) return 8.0;
  if (parameter.unit == "s" && parameter.role == ParameterRole::kShape) return 8.0;
  return parameter.typical;
}

bool sameBits(const std::vector<Pose2>& a, const std::vector<Pose2>& b) {
  for (size_t i = 0; i < a.size(); ++i)
    if (a[i].x != b[i].x || a[i].y != b[i].y || a[i].yaw != b[i].yaw) return false;
  return a.size() == b.size();
}

/// The effect with all its shapes, but only one strength.
VehicleModel withStrength(const Effect& effect, const EffectParameter& strength) {
  VehicleModel model = plainVehicle();
  for (const EffectParameter& parameter : effect.parameters)
    if (parameter.role == ParameterRole::kShape)
      model.effects.*parameter.vehicle = parameter.name == "time_2" ? 12.0 : valueFor(parameter);
  model.effects.*strength.vehicle = valueFor(strength);
  return model;
}

}  // namespace

TEST_CASE("The catalogue has every effect of old model files by its name, each name once") {
  std::set<std::string> names;
  for (const Effect& effect : effectCatalogue()) CHECK(names.insert(effect.name).second);
  for (const std::string& name : kMeasurementNames)
    CHECK(effectNamed(name).kind() == EffectKind::kMeasurement);
  for (const std::string& name : kVehicleNames)
    CHECK(effectNamed(name).kind() == EffectKind::kVehicle);
  CHECK_THROWS_AS(effectNamed("antigravity"), std::out_of_range);
}

TEST_CASE("Every entry of the catalogue is complete") {
  for (const Effect& effect : effectCatalogue()) {
    INFO(effect.name);
    for (const std::string* text : {&effect.title, &effect.sentence, &effect.equation,
                                    &effect.looks_like, &effect.separates, &effect.check})
      CHECK(text->size() > 4);
    CHECK_FALSE(effect.channels.empty());
    CHECK(effect.channels.find_first_not_of("xyw") == std::string::npos);
    REQUIRE_FALSE(effect.parameters.empty());
    CHECK(effect.parameters.front().role == ParameterRole::kStrength);
    for (const EffectParameter& parameter : effect.parameters) {
      INFO(parameter.name);
      CHECK((parameter.vehicle != nullptr) == (effect.kind() == EffectKind::kVehicle));
      CHECK((parameter.measured != nullptr) == (effect.kind() == EffectKind::kMeasurement));
      CHECK_FALSE(parameter.unit.empty());
      CHECK(parameter.min < parameter.max);
      CHECK((parameter.typical >= parameter.min && parameter.typical <= parameter.max));
      const bool strength = parameter.role == ParameterRole::kStrength;
      for (const double probe : parameter.probes)
        CHECK((probe >= parameter.min && probe <= parameter.max && (probe != 0.0 || !strength)));
      if (parameter.role == ParameterRole::kStrength) CHECK(parameter.min <= 0.0);
      CHECK((parameter.reciprocal() == (parameter.name == "inverse_limit")));
    }
  }
}

TEST_CASE("What an entry says of its search names numbers and parameters that exist") {
  const ModelDocument model;
  std::set<int> ranks;
  for (const Effect& effect : effectCatalogue()) {
    INFO(effect.name);
    for (const std::string& number : effect.search.nominal) {
      CHECK(findParameter(model, number) != nullptr);
      CHECK(effectOfPath(number) == effect.name);
    }
    if (effect.search.nuisance_rank > 0) CHECK(ranks.insert(effect.search.nuisance_rank).second);
    for (const ChangePoint& change : effect.search.change_points) {
      CHECK(parameterNamed(effect, change.time).role == ParameterRole::kShape);
      CHECK(change.fitted <= change.strengths.size());
      for (const std::string& strength : change.strengths)
        CHECK(parameterNamed(effect, strength).role == ParameterRole::kStrength);
    }
  }
  CHECK(nuisanceEffects().size() == ranks.size());
}

TEST_CASE("No two parameters share their place") {
  std::set<const double*> places;
  EffectValues values;
  MeasurementModel measurement;
  for (const Effect& effect : effectCatalogue())
    for (const EffectParameter& parameter : effect.parameters) {
      INFO(effect.name << "." << parameter.name);
      const double* place = parameter.vehicle != nullptr ? &(values.*parameter.vehicle)
                                                         : &(measurement.*parameter.measured);
      CHECK(places.insert(place).second);
    }
  CHECK(places.size() * sizeof(double) ==
        sizeof(EffectValues) - sizeof(EffectValues::added) + sizeof(MeasurementModel));
}

TEST_CASE("An effect that is off does not change a bit, whatever its shape") {
  const std::vector<Pose2> plain = richDrive(plainVehicle());
  for (const Effect& effect : effectCatalogue()) {
    if (effect.kind() != EffectKind::kVehicle) continue;
    INFO(effect.name);
    VehicleModel model = plainVehicle();
    for (const EffectParameter& parameter : effect.parameters)
      model.effects.*parameter.vehicle =
          parameter.role == ParameterRole::kShape ? valueFor(parameter) : 0.0;
    CHECK_FALSE(isOn(effect, model.effects, {}));
    CHECK(sameBits(richDrive(model), plain));
  }
}

TEST_CASE("Each strength of each effect changes the drive when it is on") {
  const std::vector<Pose2> plain = richDrive(plainVehicle());
  for (const Effect& effect : effectCatalogue()) {
    // Those of other vehicles are found by their search, tests/identification/test_layouts.cpp.
    if (effect.kind() != EffectKind::kVehicle || !effect.isOf(VehicleLayout::kTracks)) continue;
    for (const EffectParameter& parameter : effect.parameters) {
      if (parameter.role == ParameterRole::kShape) continue;
      INFO(effect.name << "." << parameter.name);
      const VehicleModel model = withStrength(effect, parameter);
      CHECK(isOn(effect, model.effects, {}));
      for (const Effect& other : effectCatalogue())
        CHECK((&other == &effect || !isOn(other, model.effects, {})));
      CHECK_FALSE(sameBits(richDrive(model), plain));
    }
  }
}

TEST_CASE("From off every effect sets in continuously") {
  const std::vector<Pose2> plain = richDrive(plainVehicle());
  for (const Effect& effect : effectCatalogue()) {
    if (effect.kind() != EffectKind::kVehicle) continue;
    for (const EffectParameter& parameter : effect.parameters) {
      if (parameter.role == ParameterRole::kShape) continue;
      INFO(effect.name << "." << parameter.name);
      VehicleModel model = withStrength(effect, parameter);
      model.effects.*parameter.vehicle *= 1e-5;
      const std::vector<Pose2> poses = richDrive(model);
      for (size_t i = 0; i < poses.size(); ++i) {
        REQUIRE(std::abs(poses[i].x - plain[i].x) < 2e-3);
        REQUIRE(std::abs(poses[i].y - plain[i].y) < 2e-3);
        REQUIRE(std::abs(poses[i].yaw - plain[i].yaw) < 2e-3);
      }
    }
  }
}

TEST_CASE("A kernel with state of every kind goes on like its copy and on its own") {
  VehicleModel model = plainVehicle();
  for (const Effect& effect : effectCatalogue())
    for (const EffectParameter& parameter : effect.parameters)
      if (parameter.vehicle != nullptr)
        model.effects.*parameter.vehicle = 0.3 * valueFor(parameter);
  VehicleKernel kernel(model, {});
  for (int i = 0; i < 7; ++i) kernel.step({1.0, 0.5}, 0.05, contextAt(0.05 * i));
  VehicleKernel copy = kernel;
  VehicleKernel other = kernel;
  for (int i = 0; i < 20; ++i) {
    kernel.step({-0.4, 0.6}, 0.05);
    other.step({1.0, 1.0}, 0.05);
    copy.step({-0.4, 0.6}, 0.05);
  }
  CHECK(sameBits({kernel.pose()}, {copy.pose()}));
  CHECK_FALSE(sameBits({kernel.pose()}, {other.pose()}));
}

TEST_CASE("Groups name effects that exist, or numbers of the nominal model") {
  const std::set<std::string> nominal{"forward_gain", "full_speed"};
  for (const ConfoundedGroup& group : confoundedGroups()) {
    INFO(group.name);
    CHECK(group.members.size() >= 2);
    CHECK_FALSE(group.because.empty());
    CHECK_FALSE(group.separates.empty());
    for (const std::string& member : group.members)
      if (nominal.count(member) == 0) CHECK_NOTHROW(effectNamed(member));
  }
  REQUIRE(confoundedGroupsOf("icr_offset").size() == 1);
  CHECK(confoundedGroupsOf("icr_offset").front()->name == "body_point");
  CHECK(confoundedGroupsOf("turn_speed_loss").empty());
}
