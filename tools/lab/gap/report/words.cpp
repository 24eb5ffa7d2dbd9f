// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/gap/report/words.hpp"

#include "tools/lab/gap/report/report.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <string>
#include <utility>

#include "tools/lab/gap/report/evidence_words.hpp"

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

/// Adapts a sentence about two tracks to a vehicle on wheels.
std::string ofVehicle(VehicleLayout layout, std::string text) {
  static constexpr std::pair<const char*, const char*> kWords[] = {
      {"difference of the tracks", "steering angle"},
      {"Both tracks", "All wheels"},
      {"both tracks", "all wheels"},
      {"track", "wheel"}};
  if (layout == VehicleLayout::kTracks) return text;
  for (const auto& [of_tracks, of_wheels] : kWords)
    for (size_t at = text.find(of_tracks); at != std::string::npos; at = text.find(of_tracks, at))
      text.replace(at, std::string(of_tracks).size(), of_wheels);
  return text;
}

std::string directionOf(const ParameterEstimate& estimate) {
  const EffectParameter* parameter = findEffectParameter(estimate.parameter);
  if (parameter == nullptr) return "";
  return estimate.value < 0.0 ? parameter->negative : parameter->positive;
}

std::string movedSentence(const ParameterEstimate& estimate) {
  const ParameterEstimate natural = naturalEstimate(estimate);
  if (estimate.parameter.find('.') == std::string::npos)
    return "A number of the model has changed: " + saidEstimate(estimate) + " instead of " +
           said(natural.before, saidUnit(natural)) + "; " +
           inSentence(shortTitleOf(effectOfPath(estimate.parameter))) +
           " would have the same effect.";
  return shortTitleOf(effectOfPath(estimate.parameter)) +
         ", which the model has, has changed: " + saidEstimate(estimate) + " instead of " +
         said(natural.before, saidUnit(natural)) + ".";
}

std::string withNumbers(const FoundEffect& effect, const std::vector<std::string>& totals) {
  std::vector<std::string> numbers;
  std::string direction;
  for (const ParameterEstimate& estimate : effect.parameters) {
    // A hard limit has no slope beyond it.
    if (lastPart(estimate.parameter) == "beyond" && estimate.value < 0.005) continue;
    numbers.push_back(saidEstimate(estimate));
    if (direction.empty()) direction = directionOf(estimate);
  }
  std::string text = plainSentence(effect);
  if (!numbers.empty()) text += ": " + joined(numbers);
  if (!direction.empty()) text += "; " + direction;
  for (const std::string& total : totals) text += "; " + total;
  if (effect.accepted)
    text += isShown(effect) ? " (accepted; the drive confirms it)"
                            : " (accepted; the drive alone does not show it: p " +
                                  saidChance(effect.p_value) + ")";
  return text + ".";
}

bool isKnown(const std::vector<RivalPair>& pairs, const std::string& one,
             const std::string& other) {
  return std::any_of(pairs.begin(), pairs.end(), [&](const RivalPair& pair) {
    return (pair.found == one && pair.other == other) || (pair.found == other && pair.other == one);
  });
}

constexpr double kNegligible = 0.01;  // relative to an error: less counts as no change

std::string saidErrors(const EndErrors& errors, bool rms) {
  return saidDistance(rms ? errors.position.rms : errors.position.median) + " and " +
         saidAngle(rms ? errors.yaw.rms : errors.yaw.median);
}

/// The dead-reckoning floor is a bound only if no model is below it.
std::string floorWords(const Gap& gap) {
  std::vector<std::string> better;
  if (gap.after.position.median < gap.floor->position.median) better.emplace_back("position");
  if (gap.after.yaw.median < gap.floor->yaw.median) better.emplace_back("heading");
  const std::string reaches = " reaches " + saidErrors(*gap.floor, false);
  if (better.empty())
    return " Dead reckoning with encoders and gyro, about the best that is possible," + reaches +
           ".";
  return " Dead reckoning with encoders and gyro" + reaches + "; the new model does better in " +
         joined(better) + ".";
}

constexpr double kBeyondChance = 2.0;  // standard errors

/// A median before and after.
struct Change {
  const char* what;
  double before;
  double after;
  double by_chance;  ///< standard error of the difference
  std::string (*said)(double);

  bool isWorse() const {
    return after > (1.0 + kNegligible) * before && after - before > kBeyondChance * by_chance;
  }
  bool isBetter() const { return before - after > kBeyondChance * by_chance; }
};

}  // namespace

std::string lastPart(const std::string& path) {
  const size_t point = path.find('.');
  return point == std::string::npos ? path : path.substr(point + 1);
}

std::string naturalUnit(const EffectParameter& parameter) {
  return parameter.natural_unit == "1" ? "" : parameter.natural_unit;
}

ParameterEstimate naturalEstimate(const ParameterEstimate& estimate) {
  const EffectParameter* parameter = findEffectParameter(estimate.parameter);
  if (parameter == nullptr || !parameter->reciprocal()) return estimate;
  ParameterEstimate natural = estimate;
  natural.parameter = parameter->natural_name;
  natural.unit = parameter->natural_unit;
  natural.value = naturalValue(*parameter, estimate.value);
  natural.before = naturalValue(*parameter, estimate.before);
  // A reciprocal of zero or less means no limit.
  natural.low = naturalValue(*parameter, std::max(0.0, estimate.high));
  natural.high = naturalValue(*parameter, std::max(0.0, estimate.low));
  return natural;
}

std::string saidUnit(const ParameterEstimate& natural) {
  return natural.parameter == "friction" ? "" : natural.unit;
}

std::string saidIntervalOf(const ParameterEstimate& estimate) {
  if (std::isinf(estimate.low) && std::isinf(estimate.high)) return "not visible in this drive";
  const ParameterEstimate natural = naturalEstimate(estimate);
  return saidInterval(natural.low, natural.high, saidUnit(natural));
}

std::string saidEstimate(const ParameterEstimate& estimate) {
  const ParameterEstimate natural = naturalEstimate(estimate);
  return lastPart(natural.parameter) + " " + said(natural.value, saidUnit(natural)) + " (" +
         saidIntervalOf(estimate) + ")";
}

std::string titleOf(const std::string& effect) {
  const Effect* known = findEffect(effect);
  return known != nullptr ? known->title : effect;
}

std::string titlesOf(const std::vector<std::string>& effects,
                     std::string (*title)(const std::string&)) {
  std::vector<std::string> titles;
  for (const std::string& effect : effects) titles.push_back(title(effect));
  return joined(titles);
}

std::string shortTitleOf(const std::string& effect) {
  const std::string title = titleOf(effect);
  return title.substr(0, title.find(','));
}

std::string sentenceOf(const FoundEffect& effect) {
  return withNumbers(effect, {});
}

std::string sentenceOf(const FoundEffect& effect, const ModelDocument& model) {
  std::vector<std::string> totals;
  for (const ParameterEstimate& estimate : effect.parameters)
    if (const auto total = totalOf(estimate.parameter, model))
      totals.push_back(total->name + " " + said(total->value, total->unit));
  return ofVehicle(model.vehicle.layout(), withNumbers(effect, totals));
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

std::string termCurveUnit(const UnnamedTerm& term) {
  const std::string unit = termChannelUnit(term.channel);
  return term.times == nullptr || term.times->unit == std::string("1")
             ? unit
             : unit + " per " + term.times->unit;
}

std::string sentenceOf(const UnnamedFinding& found, const ModelDocument& model) {
  const UnnamedTerm& term = *termOfPath(model, found.name + ".0");
  const auto [least, most] = std::minmax_element(term.values.begin(), term.values.end());
  return found.name + ": " + termChannelName(term.channel) + " added to the model, by " +
         term.condition->name +
         (term.times == nullptr ? "" : std::string(", times ") + term.times->name) + ": " +
         saidInterval(*least, *most, termCurveUnit(term)) + " where " + term.condition->name +
         " is " + saidInterval(term.at.front(), term.at.back(), term.condition->unit) + "; gain " +
         threeDigits(found.gain) + " \u00b1 " + threeDigits(found.gain_error) +
         " nats on blocks that were not fitted.";
}

std::vector<std::string> sentencesOf(const GapFinding& finding) {
  std::vector<std::string> sentences;
  for (const FoundEffect& effect : finding.identified.effects)
    sentences.push_back(shortTitleOf(effect.name) + ": " +
                        inSentence(sentenceOf(effect, finding.identified.model)) +
                        evidenceSentences(effect));
  for (const ParameterEstimate& estimate : finding.identified.calibrated)
    if (estimate.moved) sentences.push_back(movedSentence(estimate));
  for (const std::string& term : finding.identified.moved_terms)
    sentences.push_back(term + ", a term that the model has, has changed.");
  for (const UnnamedFinding& found : finding.identified.unnamed)
    sentences.push_back(sentenceOf(found, finding.identified.model));
  return sentences;
}

bool isAtLimit(const GapFinding& finding, const ParameterEstimate& estimate) {
  const auto bounds = plausibleBounds(finding.identified.model, estimate.parameter);
  const double near = bounds ? 1e-6 * (bounds->max - bounds->min) : 0.0;
  return near > 0.0 && estimate.value != 0.0 &&
         (estimate.value <= bounds->min + near || estimate.value >= bounds->max - near);
}

std::vector<std::string> rivalsOf(const FoundEffect& effect) {
  std::vector<std::string> names;
  for (const std::string& member : effect.group)
    if (!contains(names, member)) names.push_back(member);
  for (const RunnerUp& runner_up : effect.runner_ups)
    if (isAsGood(runner_up) && !contains(names, runner_up.effect))
      names.push_back(runner_up.effect);
  return names;
}

std::string rivalTitle(const std::string& found, const std::string& other) {
  const std::string title = inSentence(shortTitleOf(other));
  // A model may also have a separate latency of the poses.
  if (effectNamed(other).kind() == EffectKind::kMeasurement)
    for (const ConfoundedGroup* group : confoundedGroupsOf(found))
      if (group->share != nullptr && contains(group->members, other))
        return title + group->share_words;
  return title;
}

std::vector<std::string> waysToTell(const FoundEffect& effect) {
  const std::vector<std::string> rivals = rivalsOf(effect);
  std::vector<std::string> ways;
  for (const ConfoundedGroup* group : confoundedGroupsOf(effect.name))
    if (!(group->together && !ways.empty()) &&
        std::any_of(group->members.begin(), group->members.end(),
                    [&](const std::string& member) { return contains(rivals, member); }))
      ways.push_back(group->separates);
  if (ways.empty()) ways.push_back(effectNamed(effect.name).separates);
  return ways;
}

bool driveMayTell(const RivalPair& pair) {
  const std::vector<const ConfoundedGroup*> groups = confoundedGroupsOf(pair.found);
  return !pair.grouped ||
         std::none_of(groups.begin(), groups.end(), [&pair](const ConfoundedGroup* group) {
           return contains(group->members, pair.other);
         });
}

std::vector<RivalPair> rivalPairs(const GapFinding& finding) {
  std::vector<RivalPair> pairs;
  for (const FoundEffect& effect : finding.identified.effects) {
    for (const std::string& member : effect.group)
      if (!isKnown(pairs, effect.name, member)) pairs.push_back({effect.name, member, true});
    for (const RunnerUp& runner_up : effect.runner_ups)
      if (!isKnown(pairs, effect.name, runner_up.effect))
        pairs.push_back({effect.name, runner_up.effect, false, runner_up.behind, runner_up.error});
  }
  return pairs;
}

std::string gainOf(const Gap& gap) {
  std::string text =
      threeDigits(gap.horizon) +
      " s end-pose error on held-out driving: " + threeDigits(gap.before.position.median) + " -> " +
      saidDistance(gap.after.position.median) + ", heading " +
      threeDigits(gap.before.yaw.median * 180.0 / kPi) + " -> " + saidAngle(gap.after.yaw.median) +
      " (median of " + std::to_string(gap.after.executions) + " executions; rms " +
      saidErrors(gap.before, true) + " -> " + saidErrors(gap.after, true) + ").";
  if (gap.floor) text += floorWords(gap);
  if (!gap.structure_nested)
    text +=
        " The parameters were fitted without these executions, the effects were chosen with "
        "them.";
  return text;
}

std::string worseOf(const Gap& gap) {
  const Change changes[] = {
      {"position", gap.before.position.median, gap.after.position.median, gap.by_chance.position,
       saidDistance},
      {"heading", gap.before.yaw.median, gap.after.yaw.median, gap.by_chance.yaw, saidAngle}};
  std::vector<std::string> worse;
  std::string better;
  for (const Change& change : changes) {
    if (change.isWorse())
      worse.push_back(std::string(change.what) + " (median " + change.said(change.before) +
                      " before, " + change.said(change.after) + " now)");
    if (change.isBetter()) better = change.what;
  }
  if (worse.empty()) return "";
  return "Not better, but worse on held-out driving: " + joined(worse) +
         (better.empty() ? "." : "; only " + better + " got better.");
}

std::string remainsOf(const std::vector<Unexplained>& rests) {
  std::vector<std::string> channels;
  std::map<std::string, std::vector<std::string>> variables;
  for (const Unexplained& rest : rests) {
    if (variables.count(rest.channel) == 0) channels.push_back(rest.channel);
    const bool known = !rest.like.empty() && findEffect(rest.like) != nullptr;
    variables[rest.channel].push_back(
        rest.variable +
        (known ? " (like " + inSentence(shortTitleOf(rest.like)) + ", but not taken for it)" : ""));
  }
  std::string text;
  for (const std::string& channel : channels)
    text += (text.empty() ? "" : "; ") + std::string("the ") + channel + " residual depends on " +
            joined(variables[channel]);
  return text;
}

}  // namespace tread::gap
