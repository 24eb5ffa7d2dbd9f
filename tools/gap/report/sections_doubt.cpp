// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include <algorithm>
#include <cmath>

#include "tools/gap/report/effect_words.hpp"
#include "tools/gap/report/guidance.hpp"
#include "tools/gap/report/headline.hpp"
#include "tools/gap/report/sections.hpp"

namespace tread::gap {
namespace {

bool isEffect(const std::string& name) {
  return std::any_of(effectCatalogue().begin(), effectCatalogue().end(),
                     [&](const Effect& effect) { return effect.name == name; });
}

bool isMember(const ConfoundedGroup& group, const std::string& name) {
  return std::find(group.members.begin(), group.members.end(), name) != group.members.end();
}

/// Why two effects look the same, and what tells them apart; empty where no table knows them.
std::string groupWords(const std::string& effect, const std::string& other) {
  for (const ConfoundedGroup* group : confoundedGroupsOf(effect))
    if (isMember(*group, other))
      return " " + asSentence(group->because) + (group->when.empty() ? "" : ": " + group->when) +
             ". To tell: " + group->separates;
  return "";
}

std::string groupedWords(const RivalPair& pair) {
  return shortTitleOf(pair.found) + " or " + rivalTitle(pair.found, pair.other) +
         ": this drive cannot tell them apart." + groupWords(pair.found, pair.other);
}

std::string runnerUpWords(const RivalPair& pair) {
  return inSentence(shortTitleOf(pair.other)) +
         (isAsGood({pair.other, pair.behind, pair.error}) ? " (as good: " : " (less good: ") +
         threeDigits(pair.behind) + " \u00b1 " + threeDigits(pair.error) + " nats behind)";
}

/// What an effect may be taken for: its group first, then all others in one point.
void addOthers(const std::string& found, const std::vector<RivalPair>& pairs, Points& points) {
  std::vector<std::string> others;
  for (const RivalPair& pair : pairs) {
    if (pair.found != found) continue;
    if (pair.grouped)
      points.items.push_back(groupedWords(pair));
    else
      others.push_back(runnerUpWords(pair));
  }
  if (!others.empty())
    points.items.push_back("In place of " + inSentence(shortTitleOf(found)) + ": " +
                           joined(others, "or") + ". To tell: " + effectNamed(found).separates);
}

/// The smallest size that would have been found, as people say it; of a limit, which bites or does
/// not, the gentlest one.
std::string saidDetectable(const CandidateTest& test) {
  const EffectParameter* parameter = findEffectParameter(test.effect + "." + test.parameter);
  const bool limit = parameter != nullptr && parameter->reciprocal();
  if (!std::isfinite(test.detectable)) return limit ? "no limit that was tried" : "not at all";
  if (parameter == nullptr) return threeDigits(test.detectable);
  if (limit)
    return parameter->natural_name + " of " +
           said(naturalValue(*parameter, test.detectable), naturalUnit(*parameter)) + " or below";
  return said(test.detectable, parameter->unit);
}

bool isFound(const Finding& finding, const std::string& name) {
  return std::any_of(finding.identified.effects.begin(), finding.identified.effects.end(),
                     [&](const FoundEffect& effect) { return effect.name == name; });
}

}  // namespace

Section alternativesSection(const Finding& finding) {
  Section section{"What else it could be, and the drive that tells", {}};
  const std::vector<RivalPair> pairs = rivalPairs(finding);
  Points points;
  for (const FoundEffect& effect : finding.identified.effects)
    addOthers(effect.name, pairs, points);
  if (points.items.empty()) return section;
  section.blocks.push_back(points);
  Commands plans;
  for (const RivalPair& pair : pairs)
    if (finding.verdict != GapVerdict::kCannotTell && isEffect(pair.other) && driveMayTell(pair))
      plans.lines.push_back("tread-gap plan " + pair.found + " " + pair.other +
                            " --model model.yaml");
  if (!plans.lines.empty()) {
    section.blocks.push_back(Paragraph{"The shortest drive that tells two of them apart:"});
    section.blocks.push_back(plans);
  }
  return section;
}

Section notShownSection(const Finding& finding) {
  Section section{"What this drive could not show", {}};
  Table table{{"effect", "what would show it"}, {}, 2};
  for (const std::string& name : finding.identified.not_excited)
    table.rows.push_back({titleOf(name), isEffect(name) ? effectNamed(name).separates : ""});
  if (!table.rows.empty()) {
    section.blocks.push_back(Paragraph{
        "These effects may be there: nothing in this drive would have made them visible."});
    section.blocks.push_back(table);
  }
  if (!finding.search.negligible.empty())
    section.blocks.push_back(
        Paragraph{"Real but too small to matter (below 1 % of the end error), not added: " +
                  titlesOf(finding.search.negligible) + "."});
  return section;
}

Section decisionsSection(const Finding& finding) {
  Section section{"What people decided", {}};
  Points points;
  for (const Decision& decision : finding.source.decisions)
    points.items.push_back(titleOf(decision.effect) +
                           (decision.accepted
                                ? ": accepted; in the model from the start, whatever the tests say"
                                : ": rejected; it was not considered") +
                           (decision.by.empty() ? "" : " (" + decision.by + ")"));
  if (!points.items.empty()) section.blocks.push_back(points);
  return section;
}

Section candidatesSection(const Finding& finding) {
  Section section{"All candidates", {}};
  if (finding.search.candidates.empty()) return section;
  section.blocks.push_back(Paragraph{
      "The first test of each effect against the calibrated model. p is over the whole catalogue; "
      "own share is the part of its signature that no term of the model has; the last column is "
      "the smallest size that four of five drives like this one would have shown, of a limit the "
      "gentlest one."});
  Table table{{"effect", "parameter", "score", "p", "own share", "visible from"}, {}, 2};
  std::vector<CandidateTest> tests = finding.search.candidates;
  std::stable_sort(tests.begin(), tests.end(), [](const CandidateTest& a, const CandidateTest& b) {
    return std::abs(a.score) > std::abs(b.score);
  });
  for (const CandidateTest& test : tests)
    table.rows.push_back({titleOf(test.effect), test.parameter, threeDigits(test.score),
                          saidChance(test.p_value), said(test.uniqueness, "1"),
                          isFound(finding, test.effect) ? "found" : saidDetectable(test)});
  section.blocks.push_back(table);
  return section;
}

Section wordsSection() {
  Section section{"Words", {}};
  Table table{{"word", "what it means here"}, {}, 2};
  for (const Word& word : glossary()) table.rows.push_back({word.word, word.meaning});
  section.blocks.push_back(table);
  return section;
}

Page reportPage(const Finding& finding, const std::vector<InputFile>& inputs) {
  Page page;
  page.verdict = headlineOf(finding);
  page.title = page.verdict + " - tread-gap";
  page.mood = moodOf(finding.verdict);
  page.first = firstBlocks(finding);
  page.first.push_back(Paragraph{std::string("Verdict ") + verdictName(finding.verdict) +
                                     ", exit status " +
                                     std::to_string(static_cast<int>(finding.verdict)) +
                                     (finding.verdict == GapVerdict::kCannotTell
                                          ? ". No model was written."
                                          : ". Nothing is applied by itself: the new model is "
                                            "model.yaml."),
                                 true});
  for (Section& section : std::vector<Section>{
           effectsSection(finding), atlasSection(finding), executionsSection(finding, inputs),
           placesSection(finding, inputs), stepsSection(finding), parametersSection(finding),
           alternativesSection(finding), notShownSection(finding), decisionsSection(finding),
           envelopeSection(finding), logsSection(finding), candidatesSection(finding),
           wordsSection(), filesSection(finding, inputs)})
    if (!section.blocks.empty()) page.sections.push_back(std::move(section));
  return page;
}

}  // namespace tread::gap
