// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/vehicle/effects.hpp"

#include <limits>
#include <stdexcept>

#include "common/vehicle/catalogue_body.hpp"
#include "common/vehicle/catalogue_drive.hpp"
#include "common/vehicle/catalogue_ground.hpp"
#include "common/vehicle/catalogue_layouts.hpp"
#include "common/vehicle/catalogue_parts.hpp"

namespace tread {
namespace {

std::deque<Effect> allEffects() {
  std::deque<Effect> all;
  for (auto part :
       {commandEffects, powerEffects, lagEffects, steeringEffects, wheelEffects, slipEffects,
        turningEffects, turningChangeEffects, gripEffects, speedLossEffects, inertiaEffects,
        sideEffects, sidewaysEffects, timingEffects, mountingEffects})
    for (Effect& effect : part()) all.push_back(std::move(effect));
  return all;
}

/// The effects known to the program, including added ones, which are added before any computation.
struct Catalogue {
  std::deque<Effect> effects = allEffects();
  std::deque<ConfoundedGroup> groups;
  size_t added = 0;  ///< parameters

  Catalogue() {
    for (auto part : {groupsOfEveryDrive, groupsOfPoorDrives})
      for (ConfoundedGroup& group : part()) groups.push_back(std::move(group));
  }
};

Catalogue& catalogue() {
  static Catalogue all;
  return all;
}

}  // namespace

const std::deque<Effect>& effectCatalogue() {
  return catalogue().effects;
}

void addEffect(Effect effect, std::vector<ConfoundedGroup> groups) {
  Catalogue& all = catalogue();
  if (all.added + effect.parameters.size() > kMostAdded)
    throw std::runtime_error("effects that are added have at most " + std::to_string(kMostAdded) +
                             " parameters together; leave some out");
  effect.layouts = kOfTracks | kOfCars;
  for (EffectParameter& parameter : effect.parameters) parameter.added = all.added++;
  all.effects.push_back(std::move(effect));
  for (ConfoundedGroup& group : groups) all.groups.push_back(std::move(group));
}

double& valueIn(EffectValues& values, const EffectParameter& parameter) {
  return parameter.added ? values.added[*parameter.added] : values.*parameter.vehicle;
}

double valueIn(const EffectValues& values, const EffectParameter& parameter) {
  return valueIn(const_cast<EffectValues&>(values), parameter);
}

const Effect* findEffect(const std::string& name) {
  for (const Effect& effect : effectCatalogue())
    if (effect.name == name) return &effect;
  return nullptr;
}

const Effect& effectNamed(const std::string& name) {
  if (const Effect* effect = findEffect(name)) return *effect;
  throw std::out_of_range("no effect '" + name + "' in the catalogue of the vehicle model");
}

const EffectParameter& parameterNamed(const Effect& effect, const std::string& parameter) {
  for (const EffectParameter& candidate : effect.parameters)
    if (candidate.name == parameter) return candidate;
  throw std::out_of_range("effect '" + effect.name + "' has no parameter '" + parameter + "'");
}

const EffectParameter* findEffectParameter(const std::string& path) {
  const size_t dot = path.find('.');
  const Effect* effect = dot == std::string::npos ? nullptr : findEffect(path.substr(0, dot));
  if (effect == nullptr) return nullptr;
  for (const EffectParameter& parameter : effect->parameters)
    if (path.compare(dot + 1, std::string::npos, parameter.name) == 0) return &parameter;
  return nullptr;
}

std::string effectOfPath(const std::string& path) {
  const size_t dot = path.find('.');
  if (dot != std::string::npos) return path.substr(0, dot);
  for (const Effect& effect : effectCatalogue())
    if (contains(effect.search.nominal, path)) return effect.name;
  return path;
}

const Effect& effectThatIsLate(LateBy late_by) {
  for (const Effect& effect : effectCatalogue())
    if (effect.search.late_by == late_by) return effect;
  throw std::out_of_range("no effect of the catalogue is late by that");
}

std::vector<const Effect*> nuisanceEffects() {
  std::vector<const Effect*> nuisance;
  for (const Effect& effect : effectCatalogue())
    if (effect.search.nuisance_rank > 0) nuisance.push_back(&effect);
  std::sort(nuisance.begin(), nuisance.end(), [](const Effect* a, const Effect* b) {
    return a->search.nuisance_rank < b->search.nuisance_rank;
  });
  return nuisance;
}

bool isOn(const Effect& effect, const EffectValues& vehicle, const MeasurementModel& measurement) {
  for (const EffectParameter& parameter : effect.parameters) {
    if (parameter.role == ParameterRole::kShape) continue;
    const double value = parameter.measured != nullptr ? measurement.*parameter.measured
                                                       : valueIn(vehicle, parameter);
    if (value != 0.0) return true;
  }
  return false;
}

double naturalValue(const EffectParameter& parameter, double value) {
  if (!parameter.reciprocal()) return value;
  return value == 0.0 ? std::numeric_limits<double>::infinity() : 1.0 / value;
}

const std::deque<ConfoundedGroup>& confoundedGroups() {
  return catalogue().groups;
}

std::vector<const ConfoundedGroup*> confoundedGroupsOf(const std::string& effect) {
  std::vector<const ConfoundedGroup*> found;
  for (const ConfoundedGroup& group : confoundedGroups())
    if (contains(group.members, effect)) found.push_back(&group);
  return found;
}

std::vector<std::string> confoundedEffects(const std::string& effect,
                                           const MeasurementModel& measurement) {
  std::vector<std::string> others;
  for (const ConfoundedGroup* group : confoundedGroupsOf(effect)) {
    const bool lacks_share = group->share != nullptr &&
                             effectNamed(effect).kind() == EffectKind::kMeasurement &&
                             !(measurement.*group->share > 0.5);
    if (!group->named_beside || lacks_share) continue;
    for (const std::string& member : group->members)
      if (member != effect && findEffect(member) != nullptr) others.push_back(member);
  }
  return others;
}

}  // namespace tread
