// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/gap/explain.hpp"

#include <sstream>
#include <stdexcept>

#include "common/config/scalars.hpp"
#include "tools/gap/report/effect_words.hpp"
#include "tools/gap/report/guidance.hpp"

namespace tread::gap {
namespace {

constexpr size_t kWidth = 96;
constexpr size_t kIndent = 18;

std::string padded(const std::string& text, size_t width) {
  return text.size() < width ? text + std::string(width - text.size(), ' ') : text + " ";
}

std::string entry(const std::string& heading, const std::string& text) {
  return wrapped(padded(heading, kIndent) + text, kWidth, kIndent) + "\n";
}

/// The channels that an effect moves, in words.
std::string channelWords(const std::string& channels) {
  std::vector<std::string> words;
  for (const char channel : channels)
    words.push_back(channel == 'x'   ? "speed along the track"
                    : channel == 'y' ? "motion to the side"
                                     : "yaw rate");
  return joined(words);
}

std::string parameterWords(const EffectParameter& parameter) {
  if (parameter.reciprocal())
    return parameter.natural_name + " above " + said(1.0 / parameter.max, naturalUnit(parameter)) +
           ", for instance " + said(1.0 / parameter.typical, naturalUnit(parameter)) +
           " (in model files " + parameter.natural_name + ", or " + parameter.name +
           ", its reciprocal)";
  const bool shape = parameter.role == ParameterRole::kShape;
  return parameter.name + " " + saidInterval(parameter.min, parameter.max, parameter.unit) +
         ", for instance " + said(parameter.typical, parameter.unit) + " (in model files " +
         formatNumber(parameter.typical) + (parameter.unit == "1" ? "" : " " + parameter.unit) +
         ")" + (shape ? "; says when or how, not how much" : "");
}

std::string groupWords(const Effect& effect, const ConfoundedGroup& group) {
  std::vector<std::string> others;
  for (const std::string& member : group.members)
    if (member != effect.name) others.push_back(member);
  std::string text = joined(others, "or");
  if (!group.when.empty()) text += ", " + group.when;
  return text + ": " + group.because + ". " + group.separates;
}

constexpr size_t kTopicWidth = 96;
constexpr size_t kTopicIndent = 20;

std::string topicEntry(const std::string& heading, const std::string& text) {
  const std::string gap(heading.size() < kTopicIndent ? kTopicIndent - heading.size() : 1, ' ');
  return wrapped(heading + gap + text, kTopicWidth, kTopicIndent) + "\n";
}

std::string entries(const std::vector<Word>& words) {
  std::string text;
  for (const Word& word : words) text += topicEntry(word.word, word.meaning);
  return text;
}

std::string verdicts() {
  std::string text;
  for (const Advice& advice : advices())
    text += topicEntry(
        std::to_string(static_cast<int>(advice.verdict)) + " " + verdictName(advice.verdict),
        advice.meaning + ". " + advice.next);
  return text + topicEntry("2", "bad input, in one line");
}

}  // namespace

std::string wrapped(const std::string& text, size_t width, size_t indent) {
  std::string lines;
  std::string line;
  size_t at = 0;
  while (at < text.size()) {
    // Spaces belong to the word behind them, so that an indented heading keeps its own.
    size_t end = text.find_first_not_of(' ', at);
    end = text.find(' ', end == std::string::npos ? text.size() : end);
    const std::string word =
        text.substr(at, end == std::string::npos ? std::string::npos : end - at);
    if (line.size() + word.size() > width && line.size() > indent) {
      lines += line + "\n";
      line = std::string(indent, ' ') + word.substr(word.find_first_not_of(' '));
    } else {
      line += word;
    }
    at = end == std::string::npos ? text.size() : end;
  }
  return lines + line;
}

std::string explanation(const Effect& effect) {
  std::string text =
      effect.title + " - " + effect.name + ", " +
      (effect.kind() == EffectKind::kVehicle ? "of the vehicle" : "of the measurement") + "\n\n";
  text += entry("what it is", effect.sentence);
  text += entry("equation", effect.equation);
  std::string heading = "parameters";
  for (const EffectParameter& parameter : effect.parameters) {
    text += entry(heading, parameterWords(parameter));
    heading.clear();
  }
  text += entry("changes", channelWords(effect.channels));
  text += entry("looks like", effect.looks_like);
  text += entry("tell it apart", effect.separates);
  heading = "confused with";
  for (const ConfoundedGroup* group : confoundedGroupsOf(effect.name)) {
    text += entry(heading, groupWords(effect, *group));
    heading.clear();
  }
  text += entry("in two minutes", effect.check);
  return text;
}

std::string listOfEffects() {
  std::string text;
  for (const EffectKind kind : {EffectKind::kVehicle, EffectKind::kMeasurement}) {
    text += kind == EffectKind::kVehicle ? "Effects of the vehicle:\n"
                                         : "\nEffects of the measurement:\n";
    for (const Effect& effect : effectCatalogue())
      if (effect.kind() == kind) text += "  " + padded(effect.name, 22) + effect.sentence + "\n";
  }
  return text;
}

std::optional<std::string> topic(const std::string& name) {
  if (name == "start") return entries(firstSteps());
  if (name == "verdicts") return verdicts();
  if (name == "words") return entries(glossary());
  return std::nullopt;
}

std::string listOfTopics() {
  return "\nBeside effects:\n"
         "  start                 from a log of your own to a first run\n"
         "  verdicts              what each verdict means and what to do then\n"
         "  words                 what block, nats, adequacy, held-out .. mean\n";
}

}  // namespace tread::gap
