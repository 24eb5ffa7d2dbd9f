// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/gap/report/words.hpp"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <cstdio>

namespace tread::gap {
namespace {

constexpr double kDegrees = 180.0 / kPi;

struct FieldUnit {
  const char* unit;
  double factor;
  const char* said;
};

/// Units that the field says in another way.
const FieldUnit kFieldUnits[] = {{"1", 100.0, "%"},
                                 {"rad", kDegrees, "deg"},
                                 {"rad/m", kDegrees, "deg per metre"},
                                 {"1/h", 100.0, "% per hour"},
                                 {"s2/m2", 1.0, "s\u00b2/m\u00b2"},
                                 {"m/s2", 1.0, "m/s\u00b2"},
                                 {"s2/m", 1.0, "s\u00b2/m"},
                                 {"", 1.0, ""}};

FieldUnit fieldUnit(const std::string& unit) {
  for (const FieldUnit& candidate : kFieldUnits)
    if (unit == candidate.unit) return candidate;
  return {unit.c_str(), 1.0, unit.c_str()};
}

std::string withUnit(const std::string& number, const std::string& unit) {
  return unit.empty() || number == "no limit" ? number : number + " " + unit;
}

}  // namespace

std::string threeDigits(double value) {
  if (std::isnan(value)) return "-";
  if (std::isinf(value)) return "no limit";
  const double whole = std::round(value);
  if (whole == 0.0 && std::abs(value) < 1e-12) return "0";
  if (std::abs(value - whole) < 1e-9 * std::abs(value) && std::abs(value) < 1e15)
    return std::to_string(static_cast<long long>(whole));
  const int order = static_cast<int>(std::floor(std::log10(std::abs(value))));
  const int decimals = std::clamp(2 - order, 0, 6);
  char text[64];
  std::snprintf(text, sizeof text, "%.*f", decimals, value);
  if (std::string(text).find_first_of("123456789") == std::string::npos)
    std::snprintf(text, sizeof text, "%.2g", value);
  return text;
}

std::string said(double value, const std::string& unit) {
  const FieldUnit field = fieldUnit(unit);
  return withUnit(threeDigits(value * field.factor), field.said);
}

std::string saidInterval(double low, double high, const std::string& unit) {
  const FieldUnit field = fieldUnit(unit);
  return threeDigits(low * field.factor) + " to " + said(high, unit);
}

std::string saidAngle(double angle) {
  return said(angle, "rad");
}

std::string saidDistance(double distance) {
  return said(distance, "m");
}

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

std::string joined(const std::vector<std::string>& words, const std::string& joint) {
  std::string text;
  for (size_t i = 0; i < words.size(); ++i) {
    if (i > 0) text += i + 1 == words.size() ? " " + joint + " " : ", ";
    text += words[i];
  }
  return text;
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

std::string joinedSentences(const std::vector<std::string>& sentences) {
  std::string text;
  for (const std::string& sentence : sentences) text += (text.empty() ? "" : " ") + sentence;
  return text;
}

std::string withoutStop(const std::string& sentence) {
  return !sentence.empty() && sentence.back() == '.' ? sentence.substr(0, sentence.size() - 1)
                                                     : sentence;
}

std::string inSentence(const std::string& words) {
  // Abbreviations (INS, CANNOT) keep their letters.
  if (words.size() < 2 || std::isupper(static_cast<unsigned char>(words[1])) != 0) return words;
  std::string text = words;
  text[0] = static_cast<char>(std::tolower(static_cast<unsigned char>(text[0])));
  return text;
}

std::string asSentence(const std::string& words) {
  // Formulas keep their letters.
  if (words.size() > 1 && words[1] != ' ' &&
      std::islower(static_cast<unsigned char>(words[1])) == 0)
    return words;
  std::string text = words;
  if (!text.empty()) text[0] = static_cast<char>(std::toupper(static_cast<unsigned char>(text[0])));
  return text;
}

std::string saidChance(double p_value) {
  if (p_value < 0.001) return "below 0.001";
  char text[32];
  std::snprintf(text, sizeof text, "%.2g", p_value);
  return text;
}

}  // namespace tread::gap
