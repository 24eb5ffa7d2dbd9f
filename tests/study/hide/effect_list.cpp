// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/study/hide/effect_list.hpp"

#include <stdexcept>

namespace tread::blind {
namespace {

constexpr auto kPhysical = EffectForm::kPhysical;
constexpr auto kKinematic = EffectForm::kKinematic;
constexpr auto kSame = EffectShape::kSame;
constexpr auto kOther = EffectShape::kOther;

/// One line of the table.
struct Row {
  const char* name;
  EffectForm form;
  EffectShape shape;
  Hider (*make)(double size, double duration, Rng& rng);
  const char* how;
};

const Row kVehicleRows[] = {
    {"slip_ratio", kPhysical, kSame, hideSlipRatio, "belt speed per motor speed"},
    {"track_asymmetry", kPhysical, kSame, hideTrackAsymmetry, "power of the left and right stage"},
    {"motor_deadband", kPhysical, kSame, hideMotorDeadband, "dead power of each stage"},
    {"speed_saturation", kPhysical, kOther, hideSpeedSaturation, "soft limit of power"},
    {"actuator_lag", kPhysical, kSame, hideActuatorLag, "lag of the power stage"},
    {"command_delay", kPhysical, kSame, hideCommandDelay, "queue before the power stage"},
    {"slew_limit", kPhysical, kOther, hideSlewLimit, "ramp of power before the lag"},
    {"lag_asymmetry", kPhysical, kSame, hideLagAsymmetry, "lag of falling power"},
    {"battery_sag", kPhysical, kOther, hideBatterySag, "voltage that falls with what is drawn"},
    {"thermal_derating", kPhysical, kOther, hideThermalDerating,
     "motors heated by orders and current"},
    {"track_backlash", kPhysical, kOther, hideTrackBacklash, "slack between motor and belt"},
    {"track_width", kPhysical, kSame, hideTrackWidth, "scrub resistance of the ground"},
    {"yaw_rate_skid", kPhysical, kOther, hideYawRateSkid, "moment with the square of the rate"},
    {"turn_power_limit", kPhysical, kOther, hideTurnPowerLimit, "steep moment beyond a rate"},
    {"yaw_breakaway", kPhysical, kOther, hideYawBreakaway, "dry moment that creeps"},
    {"speed_understeer", kPhysical, kOther, hideSpeedUndersteer,
     "yaw damping with speed to the 2.5"},
    {"yaw_pull", kPhysical, kOther, hideYawPull, "one-sided drag: it turns and brakes"},
    {"grip_limit", kPhysical, kOther, hideGripLimit, "moment beyond a side acceleration"},
    {"reverse_yaw_gain", kPhysical, kOther, hideReverseYawGain, "yaw damping with signed speed"},
    {"yaw_inertia", kPhysical, kSame, hideYawInertia, "yaw inertia"},
    {"payload_change", kPhysical, kOther, hidePayloadChange,
     "mass, inertia, centre of pressure at a time"},
    {"terrain_change", kPhysical, kOther, hideTerrainChange,
     "surface parameters at one or two times"},
    {"slope_pitch", kPhysical, kSame, hideSlopePitch, "downhill force along"},
    {"slope_roll", kPhysical, kOther, hideSlopeRoll, "downhill force across while moving"},
    {"centrifugal_drift", kPhysical, kOther, hideCentrifugalDrift, "side force, progressive"},
    {"rolling_resistance", kPhysical, kSame, hideRollingResistance, "dry drag on the body"},
    {"quadratic_drag", kPhysical, kOther, hideQuadraticDrag,
     "drag with the square of the true speed"},
    {"turn_speed_loss", kPhysical, kOther, hideTurnSpeedLoss, "drag with the rate, first squared"},
    {"reverse_speed_gain", kPhysical, kOther, hideReverseSpeedGain,
     "push ahead with speed either way"},
    {"icr_offset", kPhysical, kSame, hideIcrOffset, "centre of pressure and of the tracks"},
    {"body_inertia", kKinematic, kSame, hideBodyInertia, "first-order lag of the body's speed"},
};

const Row kMeasurementRows[] = {
    {"ins_latency", kKinematic, kSame, hideInsLatency, "position and heading late, gyro in time"},
    {"heading_latency", kKinematic, kSame, hideHeadingLatency, "heading late"},
    {"gyro_bias", kKinematic, kOther, hideGyroBias, "bias of the rate, larger when cold"},
    {"heading_misalignment", kKinematic, kSame, hideHeadingMisalignment,
     "heading turned by an angle"},
    {"lever_arm_x", kKinematic, kSame, hideLeverArmX, "antenna ahead of the origin"},
    {"lever_arm_y", kKinematic, kSame, hideLeverArmY, "antenna beside the origin"},
    {"position_scale", kKinematic, kSame, hidePositionScale, "all positions scaled"},
};

const Row kUnknownRows[] = {
    {"stribeck_friction", kPhysical, kOther, hideStribeckFriction,
     "gear friction that fades with speed"},
    {"load_transfer", kPhysical, kOther, hideLoadTransfer,
     "yaw damping and side force with braking"},
    {"voltage_dead_time", kPhysical, kOther, hideVoltageDeadTime,
     "queue that grows with missing voltage"},
    {"steering_hysteresis", kPhysical, kOther, hideSteeringHysteresis,
     "yaw damping by the turns before"},
};

const Row kVehicleVariantRows[] = {
    {"crab", kKinematic, kSame, hideCrab, "motion at an angle to the hull"},
};

const Row kMeasurementVariantRows[] = {
    {"ins_latency_all", kKinematic, kSame, hideInsLatencyAll, "all that the INS says is late"},
};

/// What no drive can tell from an effect: other effects, and numbers of a nominal model.
std::vector<std::string> groupOf(const std::string& name) {
  if (name == "slip_ratio") return {"forward_gain", "full_speed"};
  if (name == "icr_offset") return {"lever_arm_x"};
  if (name == "lever_arm_x") return {"icr_offset"};
  if (name == "centrifugal_drift") return {"heading_latency"};
  if (name == "heading_latency") return {"centrifugal_drift"};
  if (name == "crab") return {"heading_misalignment"};
  if (name == "heading_misalignment") return {"crab"};
  if (name == "payload_change") return {"terrain_change"};
  if (name == "terrain_change") return {"payload_change"};
  // Everything late is a delay; poses that are late beside a gyro in time are not.
  if (name == "command_delay") return {"ins_latency"};
  if (name == "ins_latency_all") return {"ins_latency", "command_delay"};
  return {};
}

/// What is the same together: slip takes speed and yaw rate, a width the yaw rate, a scale the
/// speed.
std::vector<std::vector<std::string>> togetherOf(const std::string& name) {
  if (name == "slip_ratio") return {{"position_scale", "track_width"}};
  if (name == "position_scale") return {{"slip_ratio", "track_width"}};
  if (name == "track_width") return {{"position_scale", "slip_ratio"}};
  return {};
}

/// What the rest depends on that no listed effect explains.
std::vector<std::string> dependenceOf(const std::string& name) {
  if (name == "stribeck_friction") return {"speed", "command"};
  if (name == "load_transfer") return {"acceleration", "time_since_command", "previous_command"};
  if (name == "voltage_dead_time") return {"voltage", "time_since_command"};
  if (name == "steering_hysteresis") return {"previous_turn", "previous_command"};
  return {};
}

template <size_t Count>
void append(const Row (&rows)[Count], EffectKind kind, std::vector<EffectSpec>& list) {
  for (const Row& row : rows)
    list.push_back({row.name, kind, row.form, row.shape, row.how, row.make, groupOf(row.name),
                    togetherOf(row.name), dependenceOf(row.name)});
}

}  // namespace

const std::vector<EffectSpec>& effectList() {
  static const std::vector<EffectSpec> all = [] {
    std::vector<EffectSpec> list;
    append(kVehicleRows, EffectKind::kVehicle, list);
    append(kMeasurementRows, EffectKind::kMeasurement, list);
    append(kVehicleVariantRows, EffectKind::kVehicleVariant, list);
    append(kMeasurementVariantRows, EffectKind::kMeasurementVariant, list);
    append(kUnknownRows, EffectKind::kOutOfCatalogue, list);
    return list;
  }();
  return all;
}

const EffectSpec& effectNamed(const std::string& name) {
  for (const EffectSpec& effect : effectList())
    if (effect.name == name) return effect;
  throw std::invalid_argument("effect '" + name + "' is unknown; tread-hide list shows them");
}

}  // namespace tread::blind
