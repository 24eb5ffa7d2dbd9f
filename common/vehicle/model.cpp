// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/vehicle/model.hpp"

#include <cmath>
#include <stdexcept>

namespace tread {
namespace {

size_t parameterIndex(const Effect& effect, const std::string& parameter) {
  for (size_t i = 0; i < effect.parameters.size(); ++i)
    if (effect.parameters[i].name == parameter) return i;
  throw std::out_of_range("effect '" + effect.name + "' has no parameter '" + parameter + "'");
}

bool isOn(const std::vector<double>& values) {
  for (const double value : values)
    if (value != 0.0) return true;
  return false;
}

}  // namespace

VehicleModel::VehicleModel() {
  for (const Effect& effect : effectCatalogue())
    effects.emplace_back(effect.parameters.size(), 0.0);
}

double& VehicleModel::effect(const std::string& effect_name, const std::string& parameter) {
  const size_t index = effectIndex(effect_name);
  return effects.at(index).at(parameterIndex(effectCatalogue()[index], parameter));
}

double VehicleModel::effect(const std::string& effect_name, const std::string& parameter) const {
  const size_t index = effectIndex(effect_name);
  return effects.at(index).at(parameterIndex(effectCatalogue()[index], parameter));
}

TrackCommand VehicleModel::trackSpeeds(const TrackCommand& command) const {
  if (kind == CommandKind::kTrackSpeed) return command;
  return {full_speed * command.left, full_speed * command.right};
}

VehicleMotion VehicleModel::motionAt(const TrackCommand& track_speeds,
                                     const ExecutionNoise& noise) const {
  VehicleMotion motion;
  motion.left = track_speeds.left;
  motion.right = track_speeds.right;
  motion.v_body.v_x = forward_gain * noise.forward * (motion.left + motion.right) / 2.0;
  motion.v_body.omega = yaw_gain * noise.yaw * (motion.right - motion.left) / gauge;
  motion.crab = noise.crab;
  const std::vector<Effect>& catalogue = effectCatalogue();
  for (size_t i = 0; i < catalogue.size(); ++i)
    if (isOn(effects[i])) catalogue[i].apply(effects[i], motion);
  motion.v_body.v_y += motion.v_body.v_x * std::tan(motion.crab);
  return motion;
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
