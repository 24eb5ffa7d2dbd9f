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
  std::optional<size_t> added{};  ///< where the value of an added effect is
  /// Of a distance on the vehicle: plausible up to so many gauges; 0 = no matter how large it is.
  double gauges = 0.0;

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

/// Of what lies between a command and what the INS says of it, what an effect makes late.
enum class LateBy { kNothing, kCommand, kDrive, kYawRate, kSpeed, kPoses };

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
  /// Others do the same less simply: never searched for, but put in the place of one or two of
  /// them where it explains more, or as much.
  bool in_place = false;
  LateBy late_by = LateBy::kNothing;
  /// Of an effect under the wheels: what it is, where they show it.
  std::vector<std::string> in_wheels{};
};

/// Which layouts of vehicles have an effect: bits of VehicleLayout.
using VehicleLayouts = unsigned;
inline constexpr VehicleLayouts kEveryLayout = ~0U;

/// A named departure from the nominal model.
/** A new effect is one more entry of the catalogue and its value and line in model.hpp (or
 * kernel.hpp), or a file (effect_file.hpp); files, search, tests and reports learn of it from the
 * catalogue. */
struct Effect {
  std::string name;      ///< identifier in files and reports
  std::string title;     ///< what the field calls it
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
  VehicleLayouts layouts = kEveryLayout;
  std::shared_ptr<const AddedLaw> law{};  ///< of an added effect; else it is in the kernel

  /// Whether a vehicle of such a layout can have it.
  bool isOf(VehicleLayout layout) const {
    return (layouts & static_cast<VehicleLayouts>(layout)) != 0;
  }

  /// What its parameters belong to.
  EffectKind kind() const {
    return parameters.front().measured != nullptr ? EffectKind::kMeasurement : EffectKind::kVehicle;
  }
};

/// All effects: vehicle effects in the order in which they act, then measurement effects, then
/// those that were added.
const std::deque<Effect>& effectCatalogue();

struct ConfoundedGroup;

/// Adds a vehicle effect with a law, and what it is confounded with; gives its parameters places.
/** Before the first model is made: not while another thread uses the catalogue. Throws
 * std::runtime_error with one line where there are too many parameters. */
void addEffect(Effect effect, std::vector<ConfoundedGroup> groups);

/// The value of a parameter of a vehicle effect.
double& valueIn(EffectValues& values, const EffectParameter& parameter);
double valueIn(const EffectValues& values, const EffectParameter& parameter);

/// An effect by name; none for an unknown one.
const Effect* findEffect(const std::string& name);

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

/// The effect that makes something late, not nothing; its first parameter is by how much.
/** Throws std::out_of_range if the catalogue has none. */
const Effect& effectThatIsLate(LateBy late_by);

/// Whether a strength of the effect is not 0.
bool isOn(const Effect& effect, const EffectValues& vehicle, const MeasurementModel& measurement);

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
  /// Its vehicle effects all together do what its measurement effects do together: where both
  /// explain a drive equally well, a search takes the vehicle's and names the INS's beside them.
  bool together = false;
};

/// All groups: first those that no drive tells apart, then those of poor drives.
const std::deque<ConfoundedGroup>& confoundedGroups();

/// The groups that an effect is a member of.
std::vector<const ConfoundedGroup*> confoundedGroupsOf(const std::string& effect);

/// The other effects that a search names beside one that it found.
std::vector<std::string> confoundedEffects(const std::string& effect,
                                           const MeasurementModel& measurement);

}  // namespace tread
