// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <utility>
#include <vector>

#include "common/vehicle/effects.hpp"
#include "common/vehicle/kernel.hpp"
#include "common/vehicle/model.hpp"

/// The catalogue by chapters; use effectCatalogue() and confoundedGroups().
namespace tread {

inline constexpr VehicleLayouts kOfTracks = static_cast<VehicleLayouts>(VehicleLayout::kTracks);
inline constexpr VehicleLayouts kOfCars = static_cast<VehicleLayouts>(VehicleLayout::kCar);
inline constexpr VehicleLayouts kOfOmni = static_cast<VehicleLayouts>(VehicleLayout::kOmni);

/// An effect that only vehicles of these layouts have.
inline Effect only(VehicleLayouts layouts, Effect effect) {
  effect.layouts = layouts;
  return effect;
}

/// Search settings of an effect that equals another one under a second name.
inline EffectSearch secondName() {
  EffectSearch search;
  search.second_name = true;
  return search;
}

/// Search settings of an effect that another one is under a second name for some vehicles.
inline EffectSearch secondNameOf(VehicleLayouts layouts) {
  EffectSearch search;
  search.second_name_of = layouts;
  return search;
}

/// Search settings of an effect that may replace others.
inline EffectSearch inPlace() {
  EffectSearch search;
  search.in_place = true;
  return search;
}

/// Search settings of an effect that, where the wheels show it, is explained by these effects
/// instead.
inline EffectSearch inWheels(std::vector<std::string> names) {
  EffectSearch search;
  search.in_wheels = std::move(names);
  return search;
}

/// Search settings of an effect that delays something.
inline EffectSearch isLate(LateBy late_by, EffectSearch search = {}) {
  search.late_by = late_by;
  return search;
}

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

/// The reciprocal of a limit, called inverse_limit in files; `natural` is the limit's everyday
/// name.
inline EffectParameter inverseLimit(std::string unit, double max, double typical,
                                    double EffectValues::*value, std::vector<double> probes,
                                    std::string natural_name, std::string natural_unit,
                                    LimitedQuantity limited = LimitedQuantity::kNone) {
  EffectParameter parameter =
      strength("inverse_limit", std::move(unit), 0.0, max, typical, value, std::move(probes));
  parameter.natural_name = std::move(natural_name);
  parameter.natural_unit = std::move(natural_unit);
  parameter.limited = limited;
  return parameter;
}

/// Turns a parameter into a shape; a search tries the strengths with each of the probes.
inline EffectParameter shape(EffectParameter parameter, std::vector<double> probes = {}) {
  parameter.role = ParameterRole::kShape;
  if (!probes.empty()) parameter.probes = std::move(probes);
  return parameter;
}

inline EffectParameter fitted(EffectParameter parameter) {
  parameter.fitted = true;
  return parameter;
}

/// Softness of a limit: the share of the excess that still takes effect.
inline EffectParameter beyond(double EffectValues::*value) {
  return fitted(shape(strength("beyond", "1", 0.0, 0.6, 0.15, value), {0.1}));
}

inline EffectParameter searchedFromSlope(EffectParameter parameter) {
  parameter.search_from_slope = true;
  return parameter;
}

inline EffectParameter needsVoltage(EffectParameter parameter) {
  parameter.needs_voltage = true;
  return parameter;
}

inline EffectParameter withSigns(EffectParameter parameter, std::string positive,
                                 std::string negative) {
  parameter.positive = std::move(positive);
  parameter.negative = std::move(negative);
  return parameter;
}

/// A distance on the vehicle, plausible up to this many gauges.
inline EffectParameter upToGauges(double gauges, EffectParameter parameter) {
  parameter.gauges = gauges;
  return parameter;
}

inline EffectParameter withTotal(ParameterTotal total, EffectParameter parameter) {
  parameter.total = std::move(total);
  return parameter;
}

inline EffectParameter addedTo(double VehicleModel::*number, ParameterTotal total,
                               EffectParameter parameter) {
  parameter.adds_to = number;
  return withTotal(std::move(total), std::move(parameter));
}

}  // namespace tread
