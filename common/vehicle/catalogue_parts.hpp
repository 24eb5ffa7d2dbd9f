// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/vehicle/effects.hpp"

/// The catalogue by chapters; use effectCatalogue().
namespace tread {

std::vector<Effect> driveEffects();        ///< from the command to the speed asked of a track
std::vector<Effect> trackEffects();        ///< how a track gets to that speed
std::vector<Effect> turningEffects();      ///< what the ground makes of it: slip and turning
std::vector<Effect> yawEffects();          ///< limits and disturbances of turning
std::vector<Effect> speedEffects();        ///< losses of forward speed
std::vector<Effect> bodyEffects();         ///< inertia, motion to the side, slopes
std::vector<Effect> measurementEffects();  ///< what the INS makes of the true motion

/// A strength of a vehicle effect.
inline EffectParameter strength(std::string name, std::string unit, double min, double max,
                                double typical, double EffectValues::*value,
                                std::vector<double> probes = {}) {
  EffectParameter parameter{std::move(name), std::move(unit), min, max, typical, value};
  parameter.probes = std::move(probes);
  return parameter;
}

/// A strength of a measurement effect.
inline EffectParameter strength(std::string name, std::string unit, double min, double max,
                                double typical, double MeasurementModel::*value) {
  return {std::move(name), std::move(unit), min, max, typical, nullptr, value};
}

/// The reciprocal of a limit, called inverse_limit in files; natural: what people call the limit.
inline EffectParameter inverseLimit(std::string unit, double max, double typical,
                                    double EffectValues::*value, std::vector<double> probes,
                                    std::string natural_name, std::string natural_unit) {
  EffectParameter parameter =
      strength("inverse_limit", std::move(unit), 0.0, max, typical, value, std::move(probes));
  parameter.natural_name = std::move(natural_name);
  parameter.natural_unit = std::move(natural_unit);
  return parameter;
}

/// Turns a parameter into a shape.
inline EffectParameter shape(EffectParameter parameter) {
  parameter.role = ParameterRole::kShape;
  return parameter;
}

}  // namespace tread
