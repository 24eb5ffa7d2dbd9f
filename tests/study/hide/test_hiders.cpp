// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
// Hidden effects have the size in the truth file and the sign of the field's conventions.
#include <catch2/catch.hpp>

#include <cmath>
#include <set>

#include "tests/study/hide/blind_bench.hpp"
#include "tests/study/hide/suite.hpp"

using namespace tread;
using namespace tread::blind;
using tread::blind::bench::steadyTwist;
using tread::blind::bench::Twins;
using tread::blind::bench::twins;

namespace {

const Quantity& first(const Twins& both) {
  REQUIRE_FALSE(both.equivalent.empty());
  return both.equivalent.front();
}

double rmsRatio(const EndPoseError& gap, const EndPoseError& floor) {
  return std::max({gap.position.rms / floor.position.rms, gap.yaw.rms / floor.yaw.rms,
                   gap.yaw_rate / floor.yaw_rate});
}

}  // namespace

TEST_CASE("the list has the names of the catalogue, each once") {
  const std::vector<std::string> wanted{
      "slip_ratio",        "track_asymmetry",    "track_width",          "yaw_rate_skid",
      "turn_power_limit",  "yaw_breakaway",      "speed_understeer",     "yaw_pull",
      "motor_deadband",    "speed_saturation",   "actuator_lag",         "command_delay",
      "slew_limit",        "lag_asymmetry",      "battery_sag",          "thermal_derating",
      "payload_change",    "slope_pitch",        "slope_roll",           "terrain_change",
      "centrifugal_drift", "grip_limit",         "rolling_resistance",   "quadratic_drag",
      "turn_speed_loss",   "reverse_speed_gain", "reverse_yaw_gain",     "icr_offset",
      "yaw_inertia",       "body_inertia",       "track_backlash",       "ins_latency",
      "heading_latency",   "gyro_bias",          "heading_misalignment", "lever_arm_x",
      "lever_arm_y",       "position_scale"};
  std::multiset<std::string> names;
  for (const EffectSpec& effect : effectList()) names.insert(effect.name);
  for (const std::string& name : wanted) {
    CAPTURE(name);
    CHECK(names.count(name) == 1);
  }
}

TEST_CASE("at least half of the catalogue's effects do not follow the catalogue's equations") {
  int other = 0, physical = 0, all = 0;
  for (const EffectSpec& effect : effectList()) {
    if (effect.kind != EffectKind::kVehicle && effect.kind != EffectKind::kMeasurement) continue;
    ++all;
    other += effect.shape == EffectShape::kOther ? 1 : 0;
    physical += effect.form == EffectForm::kPhysical ? 1 : 0;
  }
  CHECK(2 * other >= all);
  CHECK(2 * physical >= all);
}

TEST_CASE("each effect changes the motion more the larger it is") {
  const NoiseLevel noise = *noiseLevel("low");
  const Programme programme = makeProgramme(Choice::kFull, 2.5, 5);
  const HiddenDrive plain = drive(programme, {}, noise, 5);
  const EndPoseError floor = oracleFloor(plain, {}, measure(plain.track, {}, noise, 5, 0));
  for (const EffectSpec& effect : effectList()) {
    CAPTURE(effect.name);
    const double small = rmsRatio(twins(effect.name, 1.0).gap, floor);
    const double usual = rmsRatio(twins(effect.name, 2.0).gap, floor);
    const double large = rmsRatio(twins(effect.name, 4.0).gap, floor);
    CHECK(usual > 0.5);
    CHECK(usual > 1.2 * small);
    CHECK(large > 1.2 * usual);
  }
}

TEST_CASE("an effect of hardly any size changes hardly anything") {
  for (const EffectSpec& effect : effectList()) {
    // Limits have no small end: they only become unreachable.
    if (std::string(effect.name).find("limit") != std::string::npos ||
        std::string(effect.name) == "speed_saturation")
      continue;
    CAPTURE(effect.name);
    const EndPoseError gap = twins(effect.name, 0.01).gap;
    CHECK(gap.position.rms < 0.01);
    CHECK(gap.yaw.rms < 0.015);
  }
}

TEST_CASE("what is measured in the catalogue's terms is near what was meant") {
  struct Meant {
    const char* name;
    double value;  // at size 2, without sign
  };
  const std::vector<Meant> all{{"slip_ratio", 0.10},         {"track_asymmetry", 0.04},
                               {"track_width", 0.25},        {"yaw_rate_skid", 0.25},
                               {"turn_power_limit", 1.07},   {"yaw_breakaway", 0.12},
                               {"speed_understeer", 0.25},   {"yaw_pull", 0.06},
                               {"motor_deadband", 0.10},     {"actuator_lag", 0.3},
                               {"command_delay", 0.15},      {"slew_limit", 1.0},
                               {"lag_asymmetry", 0.25},      {"battery_sag", 0.15},
                               {"thermal_derating", 0.3},    {"payload_change", 0.2},
                               {"slope_pitch", 0.04},        {"slope_roll", 0.03},
                               {"centrifugal_drift", 0.12},  {"rolling_resistance", 0.08},
                               {"quadratic_drag", 0.12},     {"turn_speed_loss", 0.12},
                               {"reverse_speed_gain", 0.06}, {"reverse_yaw_gain", 0.15},
                               {"icr_offset", 0.10},         {"yaw_inertia", 0.25},
                               {"body_inertia", 0.3},        {"track_backlash", 0.05},
                               {"ins_latency", 0.15},        {"heading_latency", 0.12},
                               {"gyro_bias", 0.03},          {"heading_misalignment", 0.05},
                               {"lever_arm_x", 0.1},         {"lever_arm_y", 0.1},
                               {"position_scale", 0.05}};
  for (const Meant& meant : all) {
    CAPTURE(meant.name);
    const double value = std::abs(first(twins(meant.name, 2.0, 6.0)).value);
    CAPTURE(value, meant.value);
    CHECK(value > 0.65 * meant.value);
    CHECK(value < 1.45 * meant.value);
  }
}

TEST_CASE("commands below the dead power do not move the vehicle, larger ones lose as much") {
  CHECK(steadyTwist({"motor_deadband"}, 2.0, {0.07, 0.07}).v_x == Approx(0.0).margin(1e-4));
  CHECK(steadyTwist({}, 0.0, {0.07, 0.07}).v_x > 0.06);
  const double lost =
      steadyTwist({}, 0.0, {0.6, 0.6}).v_x - steadyTwist({"motor_deadband"}, 2.0, {0.6, 0.6}).v_x;
  CHECK(lost == Approx(0.1).epsilon(0.03));
}

TEST_CASE("a dry yaw moment holds back small differentials and not straight driving") {
  const Twist2 plain = steadyTwist({}, 0.0, {0.55, 0.59});
  const Twist2 held = steadyTwist({"yaw_breakaway"}, 2.0, {0.55, 0.59});
  CHECK(plain.omega > 0.05);
  CHECK(held.omega < 0.02);
  CHECK(held.v_x == Approx(plain.v_x).epsilon(0.01));
}

TEST_CASE("saturation caps straight speed, the turn limit does not") {
  const sim::MotorPower full{1.0, 1.0};
  const double plain = steadyTwist({}, 0.0, full).v_x;
  CHECK(steadyTwist({"speed_saturation"}, 2.0, full).v_x < 0.75 * plain);
  CHECK(steadyTwist({"turn_power_limit"}, 2.0, full).v_x == Approx(plain).epsilon(1e-6));
  const sim::MotorPower spin{-0.5, 0.5};
  CHECK(steadyTwist({"turn_power_limit"}, 2.0, spin).omega <
        0.8 * steadyTwist({}, 0.0, spin).omega);
}

TEST_CASE("rolling resistance takes speed and not yaw rate, forwards and backwards") {
  for (const double power : {0.6, -0.6}) {
    const Twist2 plain = steadyTwist({}, 0.0, {power, power});
    const Twist2 held = steadyTwist({"rolling_resistance"}, 2.0, {power, power});
    CHECK(std::abs(plain.v_x) - std::abs(held.v_x) == Approx(0.08).epsilon(0.15));
  }
  const sim::MotorPower spin{-0.4, 0.4};
  CHECK(steadyTwist({"rolling_resistance"}, 2.0, spin).omega ==
        Approx(steadyTwist({}, 0.0, spin).omega).epsilon(0.02));
}

TEST_CASE("centrifugal drift pushes outwards") {
  const sim::MotorPower left_turn{0.3, 0.8};
  const double more =
      steadyTwist({"centrifugal_drift"}, 2.0, left_turn).v_y - steadyTwist({}, 0.0, left_turn).v_y;
  CHECK(more < -0.01);
}

TEST_CASE("lateness shifts the motion by as much") {
  const Twins both = twins("command_delay", 2.0);
  double largest = 0.0;
  for (size_t i = 100; i < both.with.track.v_clean.size(); ++i)
    largest = std::max(
        largest, std::abs(both.with.track.v_clean[i].v_x - both.without.track.v_clean[i - 15].v_x));
  CHECK(largest < 1e-6);
}

TEST_CASE("a single effect on the vehicle leaves programme, ground and instruments as they were") {
  const Twins both = twins("slip_ratio", 2.0);
  REQUIRE(both.with.programme.patterns.size() == both.without.programme.patterns.size());
  const auto ratio = [](const HiddenDrive& driven, size_t i) {
    return driven.track.v_body[i].v_x / driven.track.v_clean[i].v_x;
  };
  int compared = 0;
  for (size_t i = 0; i < both.with.track.v_body.size(); i += 50) {
    if (std::abs(both.with.track.v_clean[i].v_x) < 0.05) continue;
    CHECK(ratio(both.with, i) == Approx(ratio(both.without, i)).epsilon(1e-9));
    ++compared;
  }
  CHECK(compared > 100);
}

TEST_CASE("an effect is in the drive or on the ground, or only in the motion") {
  CHECK(placeOf(effectNamed("battery_sag")) == "drive");
  CHECK(placeOf(effectNamed("rolling_resistance")) == "ground");
  CHECK(placeOf(effectNamed("body_inertia")).empty());
  CHECK(placeOf(effectNamed("gyro_bias")).empty());
}

TEST_CASE("the plain vehicle drives as told and hardly shows what is to be hidden") {
  const Twist2 straight = steadyTwist({}, 0.0, {0.5, 0.5});
  CHECK(straight.v_x == Approx(0.61).epsilon(0.02));
  CHECK(straight.v_y == Approx(0.0).margin(1e-6));
  CHECK(straight.omega == Approx(0.0).margin(1e-6));
  const Twist2 back = steadyTwist({}, 0.0, {-0.5, -0.5});
  CHECK(back.v_x == Approx(-straight.v_x).epsilon(1e-3));
  CHECK(steadyTwist({}, 0.0, {0.04, 0.04}).v_x == Approx(0.08 * straight.v_x).margin(0.006));
}
