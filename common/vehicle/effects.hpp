// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <algorithm>
#include <deque>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "common/pattern/command.hpp"

namespace tread {

struct AddedLaw;          // added_effects.hpp
struct EffectValues;      // model.hpp
struct VehicleModel;      // model.hpp
struct MeasurementModel;  // kernel.hpp

/// Whether an effect changes the motion or only the INS's measurement of it.
enum class EffectKind { kVehicle, kMeasurement };

/// A strength switches its effect on and off (0 = off); a shape determines when or how the effect
/// acts and has no influence while all strengths are 0.
enum class ParameterRole { kStrength, kShape };

/// The quantity that a limit limits: a search tries limits just below the drive's largest demand.
enum class LimitedQuantity { kNone, kTrackSpeed, kYawRate, kLateralAcceleration };

/// The total of a parameter and the number of the model to which it is added.
struct ParameterTotal {
  std::string name;  ///< empty = not reported
  std::string unit;
  /// nullopt if the model has no number for the parameter to act on.
  std::optional<double> (*value)(const VehicleModel&) = nullptr;
};

/// One parameter of an effect.
/** The first strength of an effect is its primary one: a test from "off" varies it. */
struct EffectParameter {
  std::string name;
  std::string unit;
  double min = 0.0;                              ///< smallest value that is physically plausible
  double max = 0.0;                              ///< largest value that is physically plausible
  double typical = 0.0;                          ///< a value seen in the field, clearly visible
  double EffectValues::*vehicle = nullptr;       ///< where a vehicle effect's value is
  double MeasurementModel::*measured = nullptr;  ///< where a measurement effect's value is
  /// Of a strength: start values of a search where the slope at 0 is uninformative (thresholds,
  /// times). Of a shape: values with which a search tries the strengths. May be empty.
  std::vector<double> probes{};
  ParameterRole role = ParameterRole::kStrength;
  /// Of a limit, stored as its reciprocal: its everyday name, for instance limit in rad/s.
  std::string natural_name{};
  std::string natural_unit{};
  /// Of a limit: the quantity whose largest value in a drive determines the probes.
  LimitedQuantity limited = LimitedQuantity::kNone;
  bool search_from_slope = false;  ///< a search uses the slope at 0 although there are probes
  bool needs_voltage = false;      ///< without effect unless the battery voltage is measured
  bool fitted = false;             ///< of a shape: estimated together with the strengths
  /// Number of the model to which the value is added; the sum is never negative.
  double VehicleModel::*adds_to = nullptr;
  ParameterTotal total{};
  /// What a positive sign means on the ground, if the effect's sentence leaves that open.
  std::string positive{};
  std::string negative{};
  std::optional<size_t> added{};  ///< where the value of an added effect is
  /// Of a distance on the vehicle: plausible up to this many gauges; 0 = no limit relative to the
  /// size.
  double gauges = 0.0;

  /// Whether users see 1 / value.
  bool reciprocal() const { return !natural_name.empty(); }
};

/// A time of the session at which some strengths of an effect begin to act.
struct ChangePoint {
  std::string time;  ///< name of the shape that holds the time [s]
  /// In the same order at each change point of an effect: a later one first repeats the earlier
  /// ones.
  std::vector<std::string> strengths;
  size_t fitted = 0;  ///< number of leading ones that are tested and fitted together
};

/// What an effect delays, of the chain from a command to the INS's measurement of it.
enum class LateBy { kNothing, kCommand, kDrive, kYawRate, kSpeed, kPoses };

/// Layouts of vehicles that can have an effect: bits of VehicleLayout.
using VehicleLayouts = unsigned;
inline constexpr VehicleLayouts kEveryLayout = ~0U;

/// How a search for missing effects treats an effect.
struct EffectSearch {
  /// Numbers of the nominal model with the same influence; the first one is fitted instead.
  std::vector<std::string> nominal{};
  /// Simple causes are fitted as nuisance terms, in this order, so that they cannot pass as rarer
  /// ones; 0 = no nuisance term.
  int nuisance_rank = 0;
  std::vector<ChangePoint> change_points{};  ///< in order of time
  /// The same motion under a second name: never searched for, only reported as an alternative.
  bool second_name = false;
  VehicleLayouts second_name_of = 0;  ///< the same, for vehicles of these layouts alone
  /// Other effects imitate it less simply: never searched for, but replaces one or two of them if
  /// it explains more, or as much.
  bool in_place = false;
  LateBy late_by = LateBy::kNothing;
  /// Effects that explain this one if the wheels show it.
  std::vector<std::string> in_wheels{};
};

/// A named departure from the nominal model.
/** A new effect needs an entry in the catalogue and its value and line in model.hpp (or
 * kernel.hpp), or a file (effect_file.hpp); files, search, tests and reports take it from the
 * catalogue. */
struct Effect {
  std::string name;      ///< identifier in files and reports
  std::string title;     ///< what the field calls it
  std::string channels;  ///< of the residual: x along the track, y across it, w yaw rate
  std::string sentence;  ///< what it is, for an engineer in the field
  std::string equation;
  std::string looks_like;  ///< in the residuals
  std::string separates;   ///< the drive or measurement that distinguishes it from similar effects
  std::string check;       ///< in two minutes, with common tools
  std::vector<EffectParameter> parameters;
  /// The sentence if its first parameter is negative; empty = the sentence above holds.
  std::string negative_sentence{};
  EffectSearch search{};
  /// What to check first if its first parameter is negative; the size follows. May be empty.
  std::string negative_check{};
  VehicleLayouts layouts = kEveryLayout;
  /// Of an added effect; otherwise the kernel implements it
  std::shared_ptr<const AddedLaw> law{};

  /// Whether vehicles of a layout can have it.
  bool isOf(VehicleLayout layout) const {
    return (layouts & static_cast<VehicleLayouts>(layout)) != 0;
  }

  /// Whether a search of such a vehicle finds it under another name.
  bool isSecondName(VehicleLayout layout) const {
    return search.second_name || (search.second_name_of & static_cast<VehicleLayouts>(layout)) != 0;
  }

  /// Whose parameters it has: the vehicle's or the measurement's.
  EffectKind kind() const {
    return parameters.front().measured != nullptr ? EffectKind::kMeasurement : EffectKind::kVehicle;
  }
};

/// All effects: vehicle effects in the order in which they act, then measurement effects, then
/// added ones.
const std::deque<Effect>& effectCatalogue();

struct ConfoundedGroup;

/// Adds a vehicle effect with a law, and its confounded groups; assigns places to its parameters.
/** Call before the first model is made, and not while another thread uses the catalogue. Throws
 * std::runtime_error with one line if there are too many parameters. */
void addEffect(Effect effect, std::vector<ConfoundedGroup> groups);

/// The value of a parameter of a vehicle effect.
double& valueIn(EffectValues& values, const EffectParameter& parameter);
double valueIn(const EffectValues& values, const EffectParameter& parameter);

/// An effect by name; nullptr for an unknown one.
const Effect* findEffect(const std::string& name);

/// An effect by name; throws std::out_of_range for an unknown name.
const Effect& effectNamed(const std::string& name);

/// A parameter of an effect by name; throws std::out_of_range for an unknown one.
const EffectParameter& parameterNamed(const Effect& effect, const std::string& parameter);

/// A parameter by its path effect.parameter; nullptr for other paths, such as numbers of the
/// nominal model.
const EffectParameter* findEffectParameter(const std::string& path);

/// The effect of a path effect.parameter; for a number of the nominal model, the effect with the
/// same influence.
std::string effectOfPath(const std::string& path);

/// Effects that a search fits as nuisance terms, in that order.
std::vector<const Effect*> nuisanceEffects();

/// The effect that delays `late_by` (not kNothing); its first parameter is the delay.
/** Throws std::out_of_range if the catalogue has none. */
const Effect& effectThatIsLate(LateBy late_by);

/// Whether a strength of the effect is not 0.
bool isOn(const Effect& effect, const EffectValues& vehicle, const MeasurementModel& measurement);

/// The value shown to users: the limit itself if the reciprocal is stored (infinite for 0).
double naturalValue(const EffectParameter& parameter, double value);

/// Whether a name is among these.
inline bool contains(const std::vector<std::string>& names, const std::string& name) {
  return std::find(names.begin(), names.end(), name) != names.end();
}

/// Effects that residuals alone cannot distinguish, at all or on some drives.
struct ConfoundedGroup {
  std::string name;
  std::vector<std::string> members;  ///< names of effects or of numbers of the nominal model
  std::string when;                  ///< under which condition; empty = always
  std::string because;               ///< how one becomes the other
  std::string separates;             ///< the measurement or drive that distinguishes them
  /// If a search finds one member, it names the others as alternatives.
  bool named_beside = false;
  /// A measurement effect belongs to the group only if this share is above one half.
  double MeasurementModel::*share = nullptr;
  std::string share_words{};  ///< of the measurement effect with that share, for reports
  /// Its vehicle effects together imitate its measurement effects together: if both explain a drive
  /// equally well, a search takes the vehicle's and names the INS's as alternatives.
  bool together = false;
};

/// All groups: first those that no drive can distinguish, then those of poor drives.
const std::deque<ConfoundedGroup>& confoundedGroups();

/// The groups that an effect is a member of.
std::vector<const ConfoundedGroup*> confoundedGroupsOf(const std::string& effect);

/// The effects that a search names as alternatives of one that it found.
std::vector<std::string> confoundedEffects(const std::string& effect,
                                           const MeasurementModel& measurement);

}  // namespace tread
