// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/vehicle/model.hpp"

#include <stdexcept>

namespace tread {
namespace {

double EffectValues::*placeOf(const std::string& effect_name, const std::string& parameter) {
  const EffectParameter& found = parameterNamed(effectNamed(effect_name), parameter);
  if (found.vehicle == nullptr)
    throw std::out_of_range("'" + effect_name + "' is of the measurement, not of the vehicle");
  return found.vehicle;
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

}  // namespace tread
