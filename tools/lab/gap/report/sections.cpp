// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors

#include "tools/lab/gap/report/sections.hpp"

#include <algorithm>
#include <cmath>

#include "common/config/version.hpp"
#include "tools/lab/gap/explain.hpp"
#include "tools/lab/gap/report/headline.hpp"
#include "tools/lab/gap/report/pictures.hpp"
#include "tools/lab/gap/report/words.hpp"

namespace tread::gap {
namespace {

std::string saidRange(const GapFinding& finding, const ParameterEstimate& estimate) {
  const auto range = plausibleBounds(finding.identified.model, estimate.parameter);
  if (!range || range->min == range->max) return "";
  const EffectParameter* parameter = findEffectParameter(estimate.parameter);
  if (parameter != nullptr && parameter->reciprocal())
    return "above " + said(1.0 / range->max, naturalUnit(*parameter));
  return saidInterval(range->min, range->max, estimate.unit);
}

/// The value before; off for an effect that was added.
std::string saidBefore(const ParameterEstimate& estimate, const ParameterEstimate& natural) {
  if (findEffectParameter(estimate.parameter) != nullptr && estimate.before == 0.0) return "off";
  return said(natural.before, saidUnit(natural));
}

/// Sum of a parameter and the one that it adds to.
std::string saidTotal(const GapFinding& finding, const ParameterEstimate& estimate) {
  const auto total = totalOf(estimate.parameter, finding.identified.model);
  return total ? total->name + " " + said(total->value, total->unit) : "";
}

void addRow(const GapFinding& finding, const ParameterEstimate& estimate, const std::string& effect,
            Table& table) {
  const ParameterEstimate natural = naturalEstimate(estimate);
  table.rows.push_back({effect, lastPart(natural.parameter), saidBefore(estimate, natural),
                        said(natural.value, saidUnit(natural)) +
                            (isAtLimit(finding, estimate) ? " (at its limit)" : ""),
                        saidIntervalOf(estimate), saidRange(finding, estimate),
                        saidTotal(finding, estimate)});
}

/// Removes the last column if it is empty.
void forgetEmptyTotals(Table& table) {
  for (const std::vector<std::string>& row : table.rows)
    if (!row.back().empty()) return;
  table.header.pop_back();
  for (std::vector<std::string>& row : table.rows) row.pop_back();
}

/// Pairs of strongly correlated estimates.
Points highCorrelations(const ParameterCovariance& covariance) {
  Points points;
  const size_t size = std::min(covariance.parameters.size(), covariance.matrix.size());
  for (size_t i = 0; i < size; ++i)
    for (size_t j = i + 1; j < size; ++j) {
      const double scale = std::sqrt(covariance.matrix[i][i] * covariance.matrix[j][j]);
      const double correlation = scale > 0.0 ? covariance.matrix[i][j] / scale : 0.0;
      if (std::abs(correlation) > 0.9)
        points.items.push_back(covariance.parameters[i] + " and " + covariance.parameters[j] +
                               ": correlation " + threeDigits(correlation) +
                               "; only their combination is well determined");
    }
  return points;
}

/// Why two effects look the same and how to distinguish them; empty if no table has them.
std::string groupWords(const std::string& effect, const std::string& other) {
  for (const ConfoundedGroup* group : confoundedGroupsOf(effect))
    if (contains(group->members, other))
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

/// Alternatives of an effect: its group first, then all others in one point.
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

/// Smallest size that would have been found, in natural units; for a limit the weakest one.
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

bool isFound(const GapFinding& finding, const std::string& name) {
  return std::any_of(finding.identified.effects.begin(), finding.identified.effects.end(),
                     [&](const FoundEffect& effect) { return effect.name == name; });
}

std::vector<Block> effectsBlocks(const GapFinding& finding) {
  std::vector<Block> blocks;
  for (const FoundEffect& found : finding.identified.effects) {
    const Effect& effect = effectNamed(found.name);
    blocks.push_back(Paragraph{
        effect.title + " (" + effect.name + ", " +
        (effect.kind() == EffectKind::kVehicle ? "of the vehicle" : "of the measurement") + ")"});
    blocks.push_back(
        Points{{"Equation: " + effect.equation, "In the residuals: " + effect.looks_like,
                "In two minutes: " + checkOf(found),
                "Evidence: score " + threeDigits(found.score) + ", p " + saidChance(found.p_value) +
                    ", gain " + threeDigits(found.gain) + " \u00b1 " +
                    threeDigits(found.gain_error) + " nats on blocks that were not fitted"}});
  }
  return blocks;
}

std::vector<Block> unnamedBlocks(const GapFinding& finding) {
  std::vector<Block> blocks;
  Pictures pictures{{},
                    "Dots: residuals of the model without the term, means over cells. Line: the "
                    "term, with its 95 % band. Beyond its ends it is constant."};
  Commands names;
  for (const UnnamedFinding& found : finding.identified.unnamed) {
    const UnnamedTerm& term = *termOfPath(finding.identified.model, found.name + ".0");
    pictures.svg.push_back(termPicture(term, found));
    names.lines.push_back("tread-gap name model.yaml " + found.name + " YOUR_NAME");
  }
  if (pictures.svg.empty()) return blocks;
  blocks.push_back(
      Paragraph{"No effect of the catalogue has this shape. The new model simulates it "
                "nevertheless; to give it a name:"});
  blocks.push_back(names);
  blocks.push_back(pictures);
  return blocks;
}

std::vector<Block> parametersBlocks(const GapFinding& finding) {
  std::vector<Block> blocks;
  Table table{
      {"term", "parameter", "before", "now", "95 % interval", "plausible", "in all"}, {}, 2};
  for (const FoundEffect& effect : finding.identified.effects)
    for (const ParameterEstimate& estimate : effect.parameters)
      addRow(finding, estimate, titleOf(effect.name), table);
  for (const ParameterEstimate& estimate : finding.identified.calibrated) {
    const bool term = findEffectParameter(estimate.parameter) != nullptr;
    addRow(finding, estimate,
           term ? titleOf(effectOfPath(estimate.parameter)) : std::string("nominal model"), table);
  }
  if (table.rows.empty()) return blocks;
  forgetEmptyTotals(table);
  blocks.push_back(table);
  const Points pairs = highCorrelations(finding.identified.model.covariance);
  if (!pairs.items.empty()) blocks.push_back(pairs);
  return blocks;
}

std::vector<Block> envelopeBlocks(const GapFinding& finding) {
  if (!finding.identified.model.envelope || finding.verdict == GapVerdict::kCannotTell) return {};
  const Envelope& envelope = *finding.identified.model.envelope;
  return {Paragraph{
      "It was made from motions up to " + said(envelope.v, "m/s") + ", " +
      said(envelope.omega, "rad/s") + " and " + said(envelope.v_omega, "m/s2") +
      " sideways (speed times yaw rate). The model file carries these numbers, and the simulator "
      "warns beyond them: there it extrapolates."}};
}

std::vector<Block> filesBlocks(const GapFinding& finding, const std::vector<InputFile>& inputs) {
  Table table{{"file", "as", "SHA-256"}, {}, 3};
  for (const InputFile& input : inputs) {
    const char* role = input.role == InputFile::Role::kModel   ? "model"
                       : input.role == InputFile::Role::kTrain ? "training"
                                                               : "test";
    table.rows.push_back({input.name, role, input.sha256});
  }
  return {table,
          Paragraph{std::string(toolVersion()) + ", seed " + std::to_string(finding.source.seed) +
                    ". The same files and the same seed give the same report."}};
}

std::vector<Block> alternativesBlocks(const GapFinding& finding) {
  std::vector<Block> blocks;
  const std::vector<RivalPair> pairs = rivalPairs(finding);
  Points points;
  for (const FoundEffect& effect : finding.identified.effects)
    addOthers(effect.name, pairs, points);
  if (points.items.empty()) return blocks;
  blocks.push_back(points);
  Commands plans;
  for (const RivalPair& pair : pairs)
    if (finding.verdict != GapVerdict::kCannotTell && findEffect(pair.other) != nullptr &&
        driveMayTell(pair))
      plans.lines.push_back("tread-gap plan " + pair.found + " " + pair.other +
                            " --model model.yaml");
  if (!plans.lines.empty()) {
    blocks.push_back(Paragraph{"The shortest drive that distinguishes two of them:"});
    blocks.push_back(plans);
  }
  return blocks;
}

std::vector<Block> notShownBlocks(const GapFinding& finding) {
  std::vector<Block> blocks;
  Table table{{"effect", "what would show it"}, {}, 2};
  for (const std::string& name : finding.identified.not_excited)
    table.rows.push_back({titleOf(name), effectNamed(name).separates});
  if (!table.rows.empty()) {
    blocks.push_back(
        Paragraph{"These effects may be present: this drive could not have shown them."});
    blocks.push_back(table);
  }
  if (!finding.search.negligible.empty())
    blocks.push_back(
        Paragraph{"Real but too small to matter (below 1 % of the end error), not added: " +
                  titlesOf(finding.search.negligible) + "."});
  return blocks;
}

std::vector<Block> decisionsBlocks(const GapFinding& finding) {
  Points points;
  for (const EffectDecision& decision : finding.source.decisions)
    points.items.push_back(titleOf(decision.effect) +
                           (decision.accepted
                                ? ": accepted; in the model from the start, whatever the tests say"
                                : ": rejected; it was not considered") +
                           (decision.by.empty() ? "" : " (" + decision.by + ")"));
  if (points.items.empty()) return {};
  return {points};
}

std::vector<Block> candidatesBlocks(const GapFinding& finding) {
  if (finding.search.candidates.empty()) return {};
  Table table{{"effect", "parameter", "score", "p", "own share", "visible from"}, {}, 2};
  std::vector<CandidateTest> tests = finding.search.candidates;
  std::stable_sort(tests.begin(), tests.end(), [](const CandidateTest& a, const CandidateTest& b) {
    return std::abs(a.score) > std::abs(b.score);
  });
  for (const CandidateTest& test : tests)
    table.rows.push_back({titleOf(test.effect), test.parameter, threeDigits(test.score),
                          saidChance(test.p_value), said(test.uniqueness, "1"),
                          isFound(finding, test.effect) ? "found" : saidDetectable(test)});
  return {
      Paragraph{"The first test of each effect against the calibrated model. p is over the "
                "whole catalogue; "
                "own share is the part of its signature that no term of the model explains; the "
                "last column is "
                "the smallest size that four of five such drives would have shown, of "
                "a limit the "
                "gentlest one."},
      table};
}

std::vector<Block> wordsBlocks() {
  Table table{{"word", "what it means here"}, {}, 2};
  for (const Word& word : glossary()) table.rows.push_back({word.word, word.meaning});
  return {table};
}

std::vector<Block> logsBlocks(const GapFinding& finding) {
  std::vector<Block> blocks;
  Points points;
  for (const LogNote& note : finding.source.log_notes)
    points.items.push_back((note.log.empty() ? "" : note.log + ": ") + note.what +
                           (note.isFatal() ? " (nothing can be concluded from this log)" : ""));
  if (finding.source.log_notes.empty()) points.items.push_back("Nothing unusual.");
  blocks.push_back(points);
  if (finding.source.blocks > 0)
    blocks.push_back(Paragraph{
        std::to_string(finding.source.blocks) +
        (finding.source.brief ? " blocks of " : " independent blocks of ") +
        threeDigits(finding.source.block_length) +
        " s; all significance levels count blocks, not samples. " +
        (finding.source.brief
             ? "Neighbouring blocks are that short that they share their ground, "
               "so more evidence is asked for; the residuals were not tested."
             : "Test of the residuals: p " + saidChance(finding.adequacy.p_value) + ".")});
  return blocks;
}

}  // namespace

std::string toolVersion() {
  return std::string("tread-gap ") + version();
}

Page reportPage(const GapFinding& finding, const std::vector<InputFile>& inputs) {
  Page page;
  page.verdict = headlineOf(finding);
  page.title = page.verdict + " - tread-gap";
  page.mood = moodOf(finding.verdict);
  page.first = firstBlocks(finding);
  page.first.push_back(Paragraph{std::string("Verdict ") + verdictName(finding.verdict) +
                                     ", exit status " +
                                     std::to_string(exitStatus(finding.verdict)) +
                                     (finding.verdict == GapVerdict::kCannotTell
                                          ? ". No model was written."
                                          : ". Nothing is applied automatically: the new model is "
                                            "model.yaml."),
                                 true});
  const bool told = finding.verdict != GapVerdict::kCannotTell;
  std::vector<Section> sections{
      {told ? "What was found" : "Effects where the fit ended", effectsBlocks(finding)}};
  sections.push_back({"Unnamed terms", unnamedBlocks(finding)});
  for (Section& section : evidenceSections(finding, inputs)) sections.push_back(std::move(section));
  for (Section& section : std::vector<Section>{
           {told ? "Parameters of the new model" : "Parameters where the fit ended",
            parametersBlocks(finding)},
           {"Alternatives, and the drive that decides", alternativesBlocks(finding)},
           {"What this drive could not show", notShownBlocks(finding)},
           {"What people decided", decisionsBlocks(finding)},
           {"Where the new model holds", envelopeBlocks(finding)},
           {"State of the logs", logsBlocks(finding)},
           {"All candidates", candidatesBlocks(finding)},
           {"Words", wordsBlocks()},
           {"Versions and files", filesBlocks(finding, inputs)}})
    sections.push_back(std::move(section));
  for (Section& section : sections)
    if (!section.blocks.empty()) page.sections.push_back(std::move(section));
  return page;
}

}  // namespace tread::gap
