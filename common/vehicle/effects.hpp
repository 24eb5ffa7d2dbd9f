// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <optional>
#include <string>
#include <vector>

namespace tread {

struct VehicleModel;

/// Values of the parameters of all vehicle effects, in the order in which they act; 0 = off.
/** What each one means, its unit and its bounds stand in the catalogue (effects.hpp). Limits are
 * held as their reciprocals, so that no limit is 0 and small values are weak effects. */
struct EffectValues {
  // What the drive makes of a command, per track.
  double command_delay = 0.0;         ///< [s], added to the model's delay
  double motor_deadband = 0.0;        ///< [m/s]
  double speed_saturation = 0.0;      ///< [s/m], 1 / top speed
  double battery_sag_per_hour = 0.0;  ///< [1/h]
  double battery_sag_per_drop = 0.0;  ///< [1]
  double thermal_derating = 0.0;      ///< [1]
  double thermal_time = 240.0;        ///< [s], shape
  double track_asymmetry = 0.0;       ///< [1]
  double actuator_lag = 0.0;          ///< [s], added to the model's lag
  double lag_asymmetry = 0.0;         ///< [s]
  double slew_limit = 0.0;            ///< [s2/m], 1 / greatest acceleration
  double track_backlash = 0.0;        ///< [m]
  // What the ground makes of the tracks.
  double slip_ratio = 0.0;           ///< [1]
  double terrain_time_1 = 0.0;       ///< [s], shape
  double terrain_time_2 = 0.0;       ///< [s], shape
  double terrain_slip_1 = 0.0;       ///< [1]
  double terrain_width_1 = 0.0;      ///< [1]
  double terrain_breakaway_1 = 0.0;  ///< [rad/s]
  double terrain_slip_2 = 0.0;       ///< [1]
  double terrain_width_2 = 0.0;      ///< [1]
  double terrain_breakaway_2 = 0.0;  ///< [rad/s]
  double track_width = 0.0;          ///< [1]
  double yaw_rate_skid = 0.0;        ///< [s]
  double yaw_breakaway = 0.0;        ///< [rad/s]
  double turn_power_limit = 0.0;     ///< [s/rad], 1 / greatest yaw rate
  double speed_understeer = 0.0;     ///< [s2/m2]
  double reverse_yaw_gain = 0.0;     ///< [s/m]
  double payload_yaw = 0.0;          ///< [1]
  double payload_speed = 0.0;        ///< [1]
  double payload_icr = 0.0;          ///< [m]
  double payload_time = 0.0;         ///< [s], shape
  double grip_limit = 0.0;           ///< [1], 1 / friction
  double yaw_pull = 0.0;             ///< [rad/m]
  double yaw_rate_offset = 0.0;      ///< [rad/s]
  double turn_speed_loss = 0.0;      ///< [s]
  double reverse_speed_gain = 0.0;   ///< [1]
  double quadratic_drag = 0.0;       ///< [s/m]
  double rolling_resistance = 0.0;   ///< [m/s]
  // The body.
  double yaw_inertia = 0.0;        ///< [s]
  double body_inertia = 0.0;       ///< [s]
  double icr_offset = 0.0;         ///< [m]
  double crab = 0.0;               ///< [rad]
  double centrifugal_drift = 0.0;  ///< [s]
  double slope_pitch = 0.0;        ///< [s]
  double slope_roll = 0.0;         ///< [s]
};

/// Values of the parameters of all measurement effects: what the INS makes of the true motion.
/** See measurement.hpp for what they do, effects.hpp for units and bounds; 0 = off. */
struct MeasurementModel {
  double ins_latency = 0.0;           ///< [s]
  double ins_latency_gyro = 0.0;      ///< [1], shape: share of it that the yaw rate has, too
  double heading_latency = 0.0;       ///< [s], of the heading behind the position
  double position_scale = 0.0;        ///< [1]
  double lever_arm_x = 0.0;           ///< [m]
  double lever_arm_y = 0.0;           ///< [m]
  double heading_misalignment = 0.0;  ///< [rad]
  double gyro_bias = 0.0;             ///< [rad/s]
  double gyro_bias_heading = 0.0;     ///< [1], shape: share of it that the heading integrates
};

/// Whether an effect changes the motion or only what the INS says of it.
enum class EffectKind { kVehicle, kMeasurement };

/// A strength switches its effect on and off (0 = off); a shape says when or how the effect acts
/// and does nothing while all strengths are 0.
enum class ParameterRole { kStrength, kShape };

/// What a limit limits: a search tries limits just below the most that a drive demands of it.
enum class LimitedQuantity { kNone, kTrackSpeed, kYawRate, kLateralAcceleration };

/// What a parameter and the number of the model that it acts on come to.
struct ParameterTotal {
  std::string name;  ///< empty = there is none to tell
  std::string unit;
  /// Nothing where the model has nothing for the parameter to act on.
  std::optional<double> (*value)(const VehicleModel&) = nullptr;
};

/// One parameter of an effect.
/** The first strength of an effect is its primary one: what a test from "off" looks along. */
struct EffectParameter {
  std::string name;
  std::string unit;
  double min = 0.0;      ///< smallest value that is physically plausible
  double max = 0.0;      ///< largest value that is physically plausible
  double typical = 0.0;  ///< a value met in the field; the effect is clearly visible with it
  double EffectValues::*vehicle = nullptr;       ///< where a vehicle effect's value is
  double MeasurementModel::*measured = nullptr;  ///< where a measurement effect's value is
  /// Of a strength: values to begin a search at where the slope at 0 says nothing (thresholds,
  /// times). Of a shape: values with which a search tries the strengths. May be empty.
  std::vector<double> probes{};
  ParameterRole role = ParameterRole::kStrength;
  /// Of a limit, held as its reciprocal: what people call it, for instance limit in rad/s.
  std::string natural_name{};
  std::string natural_unit{};
  /// Of a limit: what a search measures in a drive to choose its probes.
  LimitedQuantity limited = LimitedQuantity::kNone;
  bool search_from_slope = false;  ///< a search uses the slope at 0, although there are probes
  bool needs_voltage = false;      ///< without a measured battery voltage it does nothing
  bool fitted = false;             ///< of a shape: a fit of the effect estimates it, too
  /// Number of the model to which the value is added; the sum is never negative.
  double VehicleModel::*adds_to = nullptr;
  ParameterTotal total{};
  /// What the sign means on the ground, where the effect's sentence leaves that open.
  std::string positive{};
  std::string negative{};

  /// Whether people say 1 / value.
  bool reciprocal() const { return !natural_name.empty(); }
};

/// A time of the session from which on some strengths of an effect act.
struct ChangePoint {
  std::string time;  ///< name of the shape that holds the time [s]
  /// In the same order at each change point of an effect: a later one first repeats the earlier.
  std::vector<std::string> strengths;
  size_t fitted = 0;  ///< so many of them, the first ones, are tested and fitted together
};

/// How a search for the effects that a model lacks treats an effect.
struct EffectSearch {
  /// Numbers of the nominal model that do the same; the first one is fitted in its place.
  std::vector<std::string> nominal{};
  /// Plain causes are fitted as nuisance terms, in this order, so that they cannot pass as
  /// something rarer; 0 = not one of them.
  int nuisance_rank = 0;
  std::vector<ChangePoint> change_points{};  ///< in order of time
  /// The same motion under a second name: never searched for, only told beside the other one.
  bool second_name = false;
};

/// A named departure from the nominal two-track model.
/** A new effect is one more entry of the catalogue and one more line of the kernel (or of the
 * measurement); files, search, tests and reports learn of it from the catalogue. */
struct Effect {
  std::string name;   ///< identifier in files and reports
  std::string title;  ///< what the field calls it
  EffectKind kind = EffectKind::kVehicle;
  std::string channels;  ///< of the residual: x along the track, y across, w yaw rate
  std::string sentence;  ///< what it is, for an engineer in the field
  std::string equation;
  std::string looks_like;  ///< in the residuals
  std::string separates;   ///< the drive or measurement that tells it from what resembles it
  std::string check;       ///< in two minutes, with what is at hand
  std::vector<EffectParameter> parameters;
  /// What it is where its first parameter is negative; empty = the sentence holds.
  std::string negative_sentence{};
  EffectSearch search{};
  /// What to check first where its first parameter is negative; the size follows. May be empty.
  std::string negative_check{};
};

/// All effects: vehicle effects in the order in which they act, then measurement effects.
const std::vector<Effect>& effectCatalogue();

/// Position of an effect in the catalogue; throws std::out_of_range for an unknown name.
size_t effectIndex(const std::string& name);

/// An effect by name; throws std::out_of_range for an unknown name.
const Effect& effectNamed(const std::string& name);

/// A parameter of an effect by name; throws std::out_of_range for an unknown one.
const EffectParameter& parameterNamed(const Effect& effect, const std::string& parameter);

/// A parameter by its path effect.parameter; none for other paths, numbers of the nominal model
/// among them.
const EffectParameter* findEffectParameter(const std::string& path);

/// The effect of a path effect.parameter; of a number of the nominal model the effect that does the
/// same.
std::string effectOfPath(const std::string& path);

/// Effects that a search fits as nuisance terms, in that order.
std::vector<const Effect*> nuisanceEffects();

/// Whether a strength of the effect is not 0.
bool isOn(const Effect& effect, const EffectValues& vehicle, const MeasurementModel& measurement);

/// The catalogue's vehicle effects that are on.
std::vector<std::string> effectsOn(const EffectValues& vehicle);

/// The value as people say it: the limit itself where the reciprocal is held (infinite for 0).
double naturalValue(const EffectParameter& parameter, double value);

/// Whether a name is among these.
inline bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Effects that residuals alone cannot tell apart, at all or on some drives.
struct ConfoundedGroup {
  std::string name;
  std::vector<std::string> members;  ///< names of effects or of numbers of the nominal model
  std::string when;                  ///< under which condition; empty = always
  std::string because;               ///< how the one becomes the other
  std::string separates;             ///< the measurement or drive that tells
  /// A search that finds one member names the others beside it.
  bool named_beside = false;
  /// A measurement effect is a member only where this share is above one half.
  double MeasurementModel::*share = nullptr;
  std::string share_words{};  ///< of the measurement effect with that share, for reports
};

/// All groups: first those that no drive tells apart, then those of poor drives.
const std::vector<ConfoundedGroup>& confoundedGroups();

/// The groups that an effect is a member of.
std::vector<const ConfoundedGroup*> confoundedGroupsOf(const std::string& effect);

/// The other effects that a search names beside one that it found.
std::vector<std::string> confoundedEffects(const std::string& effect,
                                           const MeasurementModel& measurement);

}  // namespace tread
