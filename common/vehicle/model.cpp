// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/vehicle/model_document.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <stdexcept>

namespace tread {
namespace {

double EffectValues::*placeOf(const std::string& effect_name, const std::string& parameter) {
  const EffectParameter& found = parameterNamed(effectNamed(effect_name), parameter);
  if (found.vehicle == nullptr)
    throw std::out_of_range("'" + effect_name + "' is of the measurement, not of the vehicle");
  return found.vehicle;
}

void warn(const char* what, const char* unit, double known, double asked,
          std::vector<std::string>& warnings) {
  if (asked <= known) return;
  char line[160];
  std::snprintf(line, sizeof line,
                "%s up to %.3g %s is asked for, the model was made from up to %.3g %s: beyond it "
                "is guesswork",
                what, asked, unit, known, unit);
  warnings.push_back(line);
}

}  // namespace

double& VehicleModel::effect(const std::string& effect_name, const std::string& parameter) {
  return effects.*placeOf(effect_name, parameter);
}

double VehicleModel::effect(const std::string& effect_name, const std::string& parameter) const {
  return effects.*placeOf(effect_name, parameter);
}

ExecutionNoise drawNoise(const ExecutionSpread& spread, std::mt19937_64& random) {
  std::normal_distribution<double> standard;
  ExecutionNoise noise;
  noise.forward = 1.0 + spread.forward * standard(random);
  noise.yaw = 1.0 + spread.yaw * standard(random);
  noise.crab = spread.crab * standard(random);
  return noise;
}

void Envelope::include(const Twist2& v_body) {
  v = std::max(v, std::abs(v_body.v_x));
  omega = std::max(omega, std::abs(v_body.omega));
  v_omega = std::max(v_omega, std::abs(v_body.v_x * v_body.omega));
}

std::vector<std::string> warningsOutside(const Envelope& known, const Envelope& asked) {
  std::vector<std::string> warnings;
  warn("speed", "m/s", known.v, asked.v, warnings);
  warn("yaw rate", "rad/s", known.omega, asked.omega, warnings);
  warn("speed times yaw rate", "m/s2", known.v_omega, asked.v_omega, warnings);
  return warnings;
}

Envelope envelopeOf(const VehicleModel& model, const std::vector<TrackCommand>& commands,
                    double period, const EntryState& entry) {
  VehicleKernel kernel(model, entry);
  Envelope envelope;
  envelope.include(kernel.twist());
  for (const TrackCommand& command : commands) {
    kernel.step(command, period);
    envelope.include(kernel.twist());
  }
  return envelope;
}

double* findParameter(ModelDocument& document, const std::string& path) {
  static const std::map<std::string, double VehicleModel::*> nominal{
      {"lag", &VehicleModel::lag},
      {"delay", &VehicleModel::delay},
      {"gauge", &VehicleModel::gauge},
      {"full_speed", &VehicleModel::full_speed},
      {"forward_gain", &VehicleModel::forward_gain},
      {"yaw_gain", &VehicleModel::yaw_gain}};
  const auto number = nominal.find(path);
  if (number != nominal.end()) return &(document.vehicle.*number->second);
  const EffectParameter* parameter = findEffectParameter(path);
  if (parameter == nullptr) return nullptr;
  if (parameter->vehicle != nullptr) return &(document.vehicle.effects.*parameter->vehicle);
  return &(document.measurement.*parameter->measured);
}

const double* findParameter(const ModelDocument& document, const std::string& path) {
  return findParameter(const_cast<ModelDocument&>(document), path);
}

std::optional<ParameterBounds> plausibleBounds(const ModelDocument& document,
                                               const std::string& path) {
  for (const ParameterBounds& bounds : document.bounds)
    if (bounds.parameter == path) return bounds;
  const EffectParameter* parameter = findEffectParameter(path);
  if (parameter == nullptr) return std::nullopt;
  const double min =
      parameter->adds_to != nullptr ? -(document.vehicle.*parameter->adds_to) : parameter->min;
  return ParameterBounds{path, min, parameter->max};
}

}  // namespace tread
