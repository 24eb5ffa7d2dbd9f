// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include "common/vehicle/effect_values.hpp"

namespace tread {

/// Whether an effect changes the motion or only what the INS says of it.
enum class EffectKind { kVehicle, kMeasurement };

/// A strength switches its effect on and off (0 = off); a shape says when or how the effect acts
/// and does nothing while all strengths are 0.
enum class ParameterRole { kStrength, kShape };

/// One parameter of an effect.
/** The first strength of an effect is its primary one: what a test from "off" looks along. */
struct EffectParameter {
  std::string name;
  std::string unit;
  double min = 0.0;      ///< of what is physically plausible
  double max = 0.0;      ///< and the largest
  double typical = 0.0;  ///< a value met in the field; the effect is clearly visible with it
  double EffectValues::*vehicle = nullptr;       ///< where a vehicle effect's value is
  double MeasurementModel::*measured = nullptr;  ///< where a measurement effect's value is
  /// Values to begin a search at where the slope at 0 says nothing (thresholds, times); else empty.
  std::vector<double> probes{};
  ParameterRole role = ParameterRole::kStrength;
  /// Of a limit, held as its reciprocal: what people call it, for instance limit in rad/s.
  std::string natural_name{};
  std::string natural_unit{};

  /// Whether people say 1 / value.
  bool reciprocal() const { return !natural_name.empty(); }
};

/// A named departure from the nominal two-track model.
/** What it cannot be told from stands in degeneracy.hpp. A new effect is one more entry of the
 * catalogue and one more line of the kernel (or of the measurement); files and tools learn of it
 * from the catalogue. */
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
};

/// All effects: vehicle effects in the order in which they act, then measurement effects.
const std::vector<Effect>& effectCatalogue();

/// Position of an effect in the catalogue; throws std::out_of_range for an unknown name.
size_t effectIndex(const std::string& name);

/// An effect by name; throws std::out_of_range for an unknown name.
const Effect& effectNamed(const std::string& name);

/// A parameter of an effect by name; throws std::out_of_range for an unknown one.
const EffectParameter& parameterNamed(const Effect& effect, const std::string& parameter);

/// Whether a strength of the effect is not 0.
bool isOn(const Effect& effect, const EffectValues& vehicle, const MeasurementModel& measurement);

/// The catalogue's vehicle effects that are on.
std::vector<std::string> effectsOn(const EffectValues& vehicle);

/// The value as people say it: the limit itself where the reciprocal is held (infinite for 0).
double naturalValue(const EffectParameter& parameter, double value);

}  // namespace tread
