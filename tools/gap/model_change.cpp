// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/gap/model_change.hpp"

#include <algorithm>
#include <stdexcept>

#include "common/config/scalars.hpp"
#include "common/vehicle/model_file.hpp"
#include "tools/gap/report/effect_words.hpp"

namespace tread::gap {
namespace {

/// Whether two names share a word of three letters or more: slip and slip_ratio.
bool resemble(const std::string& name, const Effect& effect) {
  size_t begin = 0;
  while (begin < name.size()) {
    const size_t end = std::min(name.find_first_of("_- ", begin), name.size());
    const std::string word = name.substr(begin, end - begin);
    if (word.size() >= 3 && effect.name.find(word) != std::string::npos) return true;
    begin = end + 1;
  }
  return false;
}

/// An effect by name, else an error that lists the names which are near.
const Effect& effectOrNear(const std::string& name) {
  std::vector<std::string> all;
  std::vector<std::string> near;
  for (const Effect& effect : effectCatalogue()) {
    if (effect.name == name) return effect;
    all.push_back(effect.name);
    if (resemble(name, effect)) near.push_back(effect.name);
  }
  const auto spelt = nearestSpelling(name, all);
  if (spelt && std::find(near.begin(), near.end(), *spelt) == near.end())
    near.insert(near.begin(), *spelt);
  if (near.empty()) return effectOrGuess(name);  // throws
  throw std::runtime_error("'" + name + "' is no effect of the catalogue; did you mean " +
                           joined(near, "or") + "?");
}

std::string parameterNames(const Effect& effect) {
  std::vector<std::string> names;
  for (const EffectParameter& parameter : effect.parameters) {
    names.push_back(parameter.name);
    if (parameter.reciprocal()) names.push_back(parameter.natural_name);
  }
  return joinWords(names);
}

/// The name under which people set the size of an effect.
std::string firstStrength(const Effect& effect) {
  const EffectParameter& first = effect.parameters.front();
  return first.reciprocal() ? first.natural_name : first.name;
}

void setEffect(ModelDocument& model, const Effect& effect, const std::string& name, double value) {
  for (const EffectParameter& parameter : effect.parameters) {
    const bool natural = parameter.reciprocal() && name == parameter.natural_name;
    if (!natural && name != parameter.name) continue;
    if (natural && value == 0.0)
      throw std::runtime_error(name + "=0: a limit of 0 lets nothing move");
    const double held = natural ? 1.0 / value : value;
    if (held < parameter.min || held > parameter.max)
      throw std::runtime_error(effect.name + "." + name + "=" + formatNumber(value) +
                               ": not plausible; " + parameter.name + " is " +
                               formatNumber(parameter.min) + " to " + formatNumber(parameter.max) +
                               (parameter.unit == "1" ? "" : " " + parameter.unit));
    valueOf(model, parameter) = held;
    return;
  }
  throw std::runtime_error("'" + name + "' is no parameter of " + effect.name + "; it has " +
                           parameterNames(effect));
}

void set(ModelDocument& model, const std::string& assignment, const Effect* last_added) {
  const size_t equals = assignment.find('=');
  const auto value =
      equals == std::string::npos ? std::nullopt : parseNumber(assignment.substr(equals + 1));
  if (!value) throw std::runtime_error("--set " + assignment + ": write parameter=number");
  const std::string path = assignment.substr(0, equals);
  const size_t point = path.find('.');
  if (point != std::string::npos) {
    setEffect(model, effectOrNear(path.substr(0, point)), path.substr(point + 1), *value);
  } else if (double* number = findParameter(model, path)) {
    if (!(*value >= 0.0))
      throw std::runtime_error("--set " + assignment + ": must not be negative");
    *number = *value;
  } else if (last_added != nullptr) {
    setEffect(model, *last_added, path, *value);
  } else {
    throw std::runtime_error("--set " + assignment +
                             ": no such parameter; write effect.parameter=number, or lag, delay, "
                             "forward_gain, yaw_gain, full_speed or gauge");
  }
}

}  // namespace

void turnOff(ModelDocument& model, const Effect& effect) {
  const ModelDocument nominal{};
  for (const EffectParameter& parameter : effect.parameters)
    valueOf(model, parameter) = valueOf(nominal, parameter);
}

void turnOn(ModelDocument& model, const Effect& effect) {
  turnOff(model, effect);
  valueOf(model, effect.parameters.front()) = effect.parameters.front().typical;
  for (const EffectParameter& parameter : effect.parameters)
    if (parameter.role == ParameterRole::kShape) valueOf(model, parameter) = parameter.typical;
}

ModelDocument changed(const ModelDocument& model, const ModelChange& change) {
  ModelDocument other = model;
  for (const std::string& name : change.remove) {
    const Effect& effect = effectOrNear(name);
    if (!isOn(effect, model))
      throw std::runtime_error("--remove " + name + ": it is off in this model");
    turnOff(other, effect);
  }
  const Effect* last_added = nullptr;
  for (const std::string& name : change.add) {
    last_added = &effectOrNear(name);
    if (isOn(*last_added, other))
      throw std::runtime_error(
          "--add " + name + ": it is already on in this model; another size: " + "--set " + name +
          "." + firstStrength(*last_added) + "=NUMBER, without it: --remove " + name);
    turnOn(other, *last_added);
  }
  for (const std::string& assignment : change.set) set(other, assignment, last_added);
  return other;
}

}  // namespace tread::gap
