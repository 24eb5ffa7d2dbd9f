// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/gap/report/words.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>

namespace tread::gap {
ParameterOfPath parameterOfPath(const std::string& path) {
  const size_t point = path.find('.');
  if (point == std::string::npos) return {};
  for (const Effect& effect : effectCatalogue()) {
    if (effect.name != path.substr(0, point)) continue;
    for (const EffectParameter& parameter : effect.parameters)
      if (parameter.name == path.substr(point + 1)) return {&effect, &parameter};
  }
  return {};
}

std::string lastPart(const std::string& path) {
  const size_t point = path.find('.');
  return point == std::string::npos ? path : path.substr(point + 1);
}

std::string naturalUnit(const EffectParameter& parameter) {
  return parameter.natural_unit == "1" ? "" : parameter.natural_unit;
}

Estimate naturalEstimate(const Estimate& estimate) {
  const EffectParameter* parameter = parameterOfPath(estimate.parameter).parameter;
  if (parameter == nullptr || !parameter->reciprocal()) return estimate;
  Estimate natural = estimate;
  natural.parameter = parameter->natural_name;
  natural.unit = parameter->natural_unit;
  natural.value = naturalValue(*parameter, estimate.value);
  natural.before = naturalValue(*parameter, estimate.before);
  // A reciprocal that may be 0 or less is no limit at all.
  natural.low = naturalValue(*parameter, std::max(0.0, estimate.high));
  natural.high = naturalValue(*parameter, std::max(0.0, estimate.low));
  return natural;
}

std::string saidUnit(const Estimate& natural) {
  return natural.parameter == "friction" ? "" : natural.unit;
}

std::string saidEstimate(const Estimate& estimate) {
  const Estimate natural = naturalEstimate(estimate);
  const std::string unit = saidUnit(natural);
  return lastPart(natural.parameter) + " " + said(natural.value, unit) + " (" +
         saidInterval(natural.low, natural.high, unit) + ")";
}

std::string titleOf(const std::string& effect) {
  for (const Effect& known : effectCatalogue())
    if (known.name == effect) return known.title;
  return effect;
}

std::string titlesOf(const std::vector<std::string>& effects, const std::string& last_joint) {
  std::vector<std::string> titles;
  titles.reserve(effects.size());
  for (const std::string& effect : effects) titles.push_back(titleOf(effect));
  return joined(titles, last_joint);
}

std::string shortTitleOf(const std::string& effect) {
  const std::string title = titleOf(effect);
  return title.substr(0, title.find(','));
}

std::string shortTitlesOf(const std::vector<std::string>& effects, const std::string& last_joint) {
  std::vector<std::string> titles;
  titles.reserve(effects.size());
  for (const std::string& effect : effects) titles.push_back(shortTitleOf(effect));
  return joined(titles, last_joint);
}

}  // namespace tread::gap
