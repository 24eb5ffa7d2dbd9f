// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/vehicle/effects.hpp"

#include <limits>
#include <stdexcept>

#include "common/vehicle/catalogue_parts.hpp"

namespace tread {
namespace {

std::vector<Effect> allEffects() {
  std::vector<Effect> all;
  for (auto part : {driveEffects, trackEffects, turningEffects, yawEffects, speedEffects,
                    bodyEffects, measurementEffects})
    for (Effect& effect : part()) all.push_back(std::move(effect));
  return all;
}

}  // namespace

const std::vector<Effect>& effectCatalogue() {
  static const std::vector<Effect> catalogue = allEffects();
  return catalogue;
}

size_t effectIndex(const std::string& name) {
  const std::vector<Effect>& catalogue = effectCatalogue();
  for (size_t i = 0; i < catalogue.size(); ++i)
    if (catalogue[i].name == name) return i;
  throw std::out_of_range("no effect '" + name + "' in the catalogue of the vehicle model");
}

const Effect& effectNamed(const std::string& name) {
  return effectCatalogue()[effectIndex(name)];
}

const EffectParameter& parameterNamed(const Effect& effect, const std::string& parameter) {
  for (const EffectParameter& candidate : effect.parameters)
    if (candidate.name == parameter) return candidate;
  throw std::out_of_range("effect '" + effect.name + "' has no parameter '" + parameter + "'");
}

bool isOn(const Effect& effect, const EffectValues& vehicle, const MeasurementModel& measurement) {
  for (const EffectParameter& parameter : effect.parameters) {
    if (parameter.role == ParameterRole::kShape) continue;
    const double value =
        parameter.vehicle != nullptr ? vehicle.*parameter.vehicle : measurement.*parameter.measured;
    if (value != 0.0) return true;
  }
  return false;
}

std::vector<std::string> effectsOn(const EffectValues& vehicle) {
  std::vector<std::string> names;
  for (const Effect& effect : effectCatalogue())
    if (effect.kind == EffectKind::kVehicle && isOn(effect, vehicle, {}))
      names.push_back(effect.name);
  return names;
}

double naturalValue(const EffectParameter& parameter, double value) {
  if (!parameter.reciprocal()) return value;
  return value == 0.0 ? std::numeric_limits<double>::infinity() : 1.0 / value;
}

}  // namespace tread
