// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/gap/report/effect_words.hpp"

#include <algorithm>
#include <string>

#include "tools/gap/report/words.hpp"

namespace tread::gap {
namespace {

bool isNegative(const FoundEffect& effect) {
  return !effect.parameters.empty() && effect.parameters.front().value < 0.0;
}

std::string plainSentence(const FoundEffect& effect) {
  const Effect& known = effectNamed(effect.name);
  return isNegative(effect) && !known.negative_sentence.empty() ? known.negative_sentence
                                                                : withoutStop(known.sentence);
}

std::string directionOf(const Estimate& estimate) {
  const EffectParameter* parameter = findEffectParameter(estimate.parameter);
  if (parameter == nullptr) return "";
  return estimate.value < 0.0 ? parameter->negative : parameter->positive;
}

std::string movedSentence(const Estimate& estimate) {
  const Estimate natural = naturalEstimate(estimate);
  if (estimate.parameter.find('.') == std::string::npos)
    return "A number of the model is another one now: " + saidEstimate(estimate) + " instead of " +
           said(natural.before, saidUnit(natural)) + "; " +
           inSentence(shortTitleOf(effectOfPath(estimate.parameter))) + " would do the same.";
  return shortTitleOf(effectOfPath(estimate.parameter)) +
         ", which the model has, is another one now: " + saidEstimate(estimate) + " instead of " +
         said(natural.before, saidUnit(natural)) + ".";
}

std::string withNumbers(const FoundEffect& effect, const std::vector<std::string>& totals) {
  std::vector<std::string> numbers;
  std::string direction;
  for (const Estimate& estimate : effect.parameters) {
    numbers.push_back(saidEstimate(estimate));
    if (direction.empty()) direction = directionOf(estimate);
  }
  std::string text = plainSentence(effect);
  if (!numbers.empty()) text += ": " + joined(numbers);
  if (!direction.empty()) text += "; " + direction;
  for (const std::string& total : totals) text += "; " + total;
  if (effect.accepted)
    text += isShown(effect) ? " (accepted; the drive shows it, too)"
                            : " (accepted; the drive alone does not show it: p " +
                                  saidChance(effect.p_value) + ")";
  return text + ".";
}

}  // namespace

std::string sentenceOf(const FoundEffect& effect) {
  return withNumbers(effect, {});
}

std::string sentenceOf(const FoundEffect& effect, const ModelDocument& model) {
  std::vector<std::string> totals;
  for (const Estimate& estimate : effect.parameters)
    if (const auto total = totalOf(estimate.parameter, model))
      totals.push_back(total->name + " " + said(total->value, total->unit));
  return withNumbers(effect, totals);
}

std::string titledSentenceOf(const FoundEffect& effect, const ModelDocument& model) {
  return shortTitleOf(effect.name) + ": " + inSentence(sentenceOf(effect, model));
}

std::optional<Total> totalOf(const std::string& path, const ModelDocument& model) {
  const EffectParameter* parameter = findEffectParameter(path);
  if (parameter == nullptr || parameter->total.value == nullptr) return std::nullopt;
  const auto value = parameter->total.value(model.vehicle);
  if (!value) return std::nullopt;
  return Total{parameter->total.name, *value, parameter->total.unit};
}

std::string checkOf(const FoundEffect& effect) {
  const Effect& known = effectNamed(effect.name);
  if (known.negative_check.empty() || !isNegative(effect)) return known.check;
  return known.negative_check + said(-effect.parameters.front().value, "1") + ". " + known.check;
}

std::vector<std::string> movedSentences(const Finding& finding) {
  std::vector<std::string> sentences;
  for (const Estimate& estimate : finding.calibrated)
    if (estimate.moved) sentences.push_back(movedSentence(estimate));
  return sentences;
}

}  // namespace tread::gap
