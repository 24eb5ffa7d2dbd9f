// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/study/hide/effect_list.hpp"

#include <algorithm>
#include <stdexcept>

namespace tread::blind {

namespace {

std::vector<EffectSpec>& wholeList() {
  static std::vector<EffectSpec> all = [] {
    std::vector<EffectSpec> list;
    for (const auto part : {driveEffects, turningEffects, bodyEffects, instrumentEffects,
                            unknownEffects, addedEffects})
      for (EffectSpec& effect : part()) list.push_back(std::move(effect));
    std::stable_sort(list.begin(), list.end(),
                     [](const EffectSpec& a, const EffectSpec& b) { return a.kind < b.kind; });
    return list;
  }();
  return all;
}

}  // namespace

const std::vector<EffectSpec>& effectList() {
  return wholeList();
}

void addEffectOfFile(const std::string& path) {
  EffectSpec spec = specOfFile(path);
  for (const EffectSpec& other : effectList())
    if (other.name == spec.name)
      throw std::invalid_argument(path + ": '" + spec.name +
                                  "' can be hidden already, by other means; give it another name");
  wholeList().push_back(std::move(spec));
}

const EffectSpec& effectNamed(const std::string& name) {
  for (const EffectSpec& effect : effectList())
    if (effect.name == name) return effect;
  throw std::invalid_argument("effect '" + name + "' is unknown; tread-hide list shows them");
}

std::string placeOf(const EffectSpec& effect) {
  if (effect.kind != EffectKind::kVehicle || effect.form != EffectForm::kPhysical) return "";
  const std::vector<EffectSpec> drive = driveEffects();
  const bool in_drive = std::any_of(drive.begin(), drive.end(), [&](const EffectSpec& other) {
    return other.name == effect.name;
  });
  return in_drive ? "drive" : "ground";
}

}  // namespace tread::blind
