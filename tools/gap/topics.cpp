// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/gap/topics.hpp"

#include "tools/gap/explain.hpp"
#include "tools/gap/report/guidance.hpp"

namespace tread::gap {
namespace {

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
