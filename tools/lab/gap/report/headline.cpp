// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/lab/gap/report/headline.hpp"

#include "tools/lab/gap/report/pictures.hpp"

#include <algorithm>

#include "tools/lab/gap/explain.hpp"
#include "tools/lab/gap/report/words.hpp"

namespace tread::gap {
namespace {

constexpr size_t kNamed = 3;  // effects that a line or a list of the first screen names

/// For fits that must not be used.
constexpr const char* kNoResult = "Where the fit ended, for information only:";

constexpr const char* kCutShort =
    "The search had no time left (--limit): these are the best terms so far.";

/// For a model that does not record its unexplained residuals, so that new ones cannot be
/// recognized.
constexpr const char* kUnknownRest =
    "The vehicle may be unchanged: this model does not record its unexplained residuals. The new "
    "one does (rest), so the next find with it reports what is new. Do not trust either where the "
    "residuals depend on something.";

constexpr const char* kFittedNumbers =
    "Numbers of the model were refitted to the log; see the table of parameters. "
    "That done: ";

/// What a brief drive tells, and what it does not, by name; empty for a longer one.
std::string briefWords(const GapFinding& finding) {
  if (!finding.source.brief || finding.search.candidates.empty()) return "";
  const std::vector<std::string>& unseen = finding.identified.not_excited;
  const double driven = static_cast<double>(finding.source.blocks) * finding.source.block_length;
  return fixed(driven, 0) +
         " s of driving: only effects that it would show in their usual size are "
         "judged" +
         (unseen.empty()
              ? ": all."
              : ". CANNOT_TELL: " + joined(unseen) + ". The report says what would show them.") +
         " Differences without a name are tested from 200 s on.";
}

/// Effects of the model whose values have changed.
std::vector<std::string> movedIn(const GapFinding& finding) {
  std::vector<std::string> names;
  for (const ParameterEstimate& estimate : finding.identified.calibrated) {
    const std::string effect = effectOfPath(estimate.parameter);
    if (estimate.moved && !contains(names, effect)) names.push_back(effect);
  }
  return names;
}

/// Names of the found effects; if there are none, of those that changed.
std::vector<std::string> namesOf(const GapFinding& finding) {
  std::vector<std::string> names;
  names.reserve(finding.identified.effects.size());
  for (const FoundEffect& effect : finding.identified.effects)
    if (isShown(effect)) names.push_back(effect.name);
  return names.empty() ? movedIn(finding) : names;
}

/// Found effects that this drive does, or does not, identify uniquely.
std::vector<const FoundEffect*> found(const GapFinding& finding, bool sure) {
  std::vector<const FoundEffect*> effects;
  for (const FoundEffect& effect : finding.identified.effects)
    if (isShown(effect) && rivalsOf(effect).empty() == sure) effects.push_back(&effect);
  return effects;
}

void byGain(std::vector<const FoundEffect*>& effects) {
  std::stable_sort(effects.begin(), effects.end(),
                   [](const FoundEffect* a, const FoundEffect* b) { return a->gain > b->gain; });
}

/// "A or B"; for many "A or one of 4 others".
std::string eitherOr(const FoundEffect& effect) {
  constexpr size_t kReadable = 2;
  std::vector<std::string> names = rivalsOf(effect);
  if (names.size() > kReadable)
    return shortTitleOf(effect.name) + " or one of " + std::to_string(names.size()) + " others";
  for (std::string& name : names) name = rivalTitle(effect.name, name);
  names.insert(names.begin(), shortTitleOf(effect.name));
  return joined(names, "or");
}

/// "A and B"; for many "A, B and 4 more", those with the largest gain first.
std::string someOf(std::vector<const FoundEffect*> effects) {
  byGain(effects);
  std::vector<std::string> names;
  for (const FoundEffect* effect : effects) names.push_back(shortTitleOf(effect->name));
  if (names.size() > kNamed) {
    names.resize(kNamed);
    names.back() = std::to_string(effects.size() - kNamed + 1) + " more";
  }
  return joined(names);
}

/// Summary in one line: certain names, then uncertain ones.
std::string foundWords(const GapFinding& finding) {
  const std::vector<const FoundEffect*> sure = found(finding, true);
  const std::vector<const FoundEffect*> open = found(finding, false);
  if (open.empty())
    return "Found: " + (sure.empty() ? titlesOf(namesOf(finding), shortTitleOf) : someOf(sure));
  const std::string begin = sure.empty() ? "" : "Found: " + someOf(sure) + "; and ";
  if (open.size() == 1)
    return begin + eitherOr(*open.front()) + ": this drive cannot tell them apart";
  return "Found: " + (sure.empty() ? "" : someOf(sure) + "; ") +
         "not sure by name: " + someOf(open);
}

/// One point per effect: its alternatives, and how to distinguish them.
void addRivals(const GapFinding& finding, Points& points) {
  for (const FoundEffect* effect : found(finding, false)) {
    std::vector<std::string> rivals = rivalsOf(*effect);
    for (std::string& rival : rivals) rival = rivalTitle(effect->name, rival);
    points.items.push_back(shortTitleOf(effect->name) + " could also be " + joined(rivals, "or") +
                           ". To tell: " + joinedSentences(waysToTell(*effect)));
  }
}

/// How to check the effects with the largest gain; the others follow further down.
void addChecks(const GapFinding& finding, Points& points) {
  std::vector<const FoundEffect*> effects;
  for (const FoundEffect& effect : finding.identified.effects) effects.push_back(&effect);
  byGain(effects);
  if (effects.size() > kNamed) effects.resize(kNamed);
  for (const FoundEffect* effect : effects)
    points.items.push_back("To check " + inSentence(shortTitleOf(effect->name)) +
                           " in two minutes: " + checkOf(*effect));
}

/// Advice on effects without a measured size.
void addUnsized(const GapFinding& finding, Points& points) {
  for (const FoundEffect& effect : finding.identified.effects)
    if (std::any_of(
            effect.parameters.begin(), effect.parameters.end(),
            [&finding](const ParameterEstimate& estimate) { return isAtLimit(finding, estimate); }))
      points.items.push_back(shortTitleOf(effect.name) +
                             " runs to its plausibility limit. Drive what shows it (" +
                             withoutStop(effectNamed(effect.name).separates) +
                             "), or leave it out: --reject " + effect.name + ".");
}

void addNext(const GapFinding& finding, std::vector<Block>& blocks) {
  Points points;
  if (finding.verdict == GapVerdict::kCannotTell) {
    addUnsized(finding, points);
    const size_t unseen = finding.identified.not_excited.size();
    if (unseen > 0)
      points.items.push_back(
          "This drive would not have shown " +
          (unseen <= kNamed
               ? inSentence(titlesOf(finding.identified.not_excited, shortTitleOf)) + "."
               : std::to_string(unseen) +
                     " effects; they are listed below, with what would show them."));
  } else {
    addRivals(finding, points);
    if (finding.verdict != GapVerdict::kAmbiguous) addChecks(finding, points);
  }
  if (!points.items.empty()) blocks.push_back(points);
}

/// Whether model and log agree only because calibrated numbers were fitted to the log.
bool isMadeByFit(const GapFinding& finding) {
  constexpr double kMuch = 0.75;
  if (!finding.gap || finding.identified.calibrated.empty()) return false;
  const Gap& gap = *finding.gap;
  return gap.after.position.median < kMuch * gap.before.position.median ||
         gap.after.yaw.median < kMuch * gap.before.yaw.median;
}

std::string opening(const GapFinding& finding) {
  switch (finding.verdict) {
    case GapVerdict::kNoDiscrepancy:
      return std::string(isMadeByFit(finding) ? kFittedNumbers : "") +
             "Prediction and INS measurement do not differ significantly" +
             (finding.source.brief ? "" : ", over the whole catalogue and on all variables") +
             ". Which effects would have been seen, from which size on, is listed below." +
             (finding.search.negligible.empty()
                  ? std::string()
                  : " Real, but too small to matter: " + titlesOf(finding.search.negligible) + ".");
    case GapVerdict::kNothingNew:
      return finding.source.brief ? ""
                                  : "The log differs from the model exactly as the drive did from "
                                    "which the model was made, and in nothing else.";
    case GapVerdict::kNotInCatalogue:
      if (!finding.identified.unnamed.empty())
        return "There is a disagreement that no effect of the catalogue explains. What "
               "has a shape is an unnamed term of the new model.";
      if (!finding.identified.moved_terms.empty())
        return "There is a disagreement that no effect of the catalogue explains: an "
               "unnamed term of the model has changed.";
      return "There is a disagreement that no effect of the catalogue explains. Naming "
             "another effect would be a guess; apart from the calibration the model is unchanged.";
    case GapVerdict::kCannotTell:
      return finding.reason + (finding.reason.empty() || finding.reason.back() == '.' ? "" : ".");
    case GapVerdict::kMeasurement:
      return "The vehicle drives as the model predicts; the INS reports it differently. Only "
             "the measurement part of the model has changed.";
    default:
      return "";
  }
}

}  // namespace

std::string headlineOf(const GapFinding& finding) {
  switch (finding.verdict) {
    case GapVerdict::kNoDiscrepancy:
      return std::string("Simulation and measurement agree") +
             (finding.source.brief ? " as far as this brief drive shows" : "") +
             (isMadeByFit(finding) ? ", once the model's own numbers are fitted" : "");
    case GapVerdict::kNothingNew:
      return finding.source.brief ? "Nothing new that this brief drive would show"
                                  : "Nothing new: only the known residuals of the model";
    case GapVerdict::kFound:
    case GapVerdict::kAmbiguous:
      return foundWords(finding);
    case GapVerdict::kPartial:
      return foundWords(finding) +
             (finding.search.cut_short ? "; the search is incomplete" : "; and something unnamed");
    case GapVerdict::kNotInCatalogue:
      return "Something that is not in the catalogue";
    case GapVerdict::kMeasurement:
      return "The INS, not the vehicle: " + titlesOf(namesOf(finding), shortTitleOf);
    case GapVerdict::kCannotTell:
      return "This drive cannot tell";
  }
  return "";
}

namespace {

/// "FOUND: Limit of turning power": the verdict's name replaces the first word of the headline.
std::string verdictLine(const GapFinding& finding) {
  const std::string found = "Found: ";
  std::string headline = headlineOf(finding);
  if (finding.verdict == GapVerdict::kFound && headline.find(found) == 0)
    headline.erase(0, found.size());
  return std::string(verdictName(finding.verdict)) + ": " + headline;
}

}  // namespace

std::vector<std::string> closingLines(const GapFinding& finding) {
  std::vector<std::string> lines{verdictLine(finding)};
  if (finding.search.cut_short) lines.push_back(std::string("  ") + kCutShort);
  if (finding.verdict == GapVerdict::kCannotTell) {
    lines.push_back("  " + finding.reason);
    if (!finding.identified.effects.empty()) lines.push_back(std::string("  ") + kNoResult);
  }
  if (const std::string brief = briefWords(finding); !brief.empty()) lines.push_back("  " + brief);
  for (const std::string& sentence : sentencesOf(finding)) lines.push_back("  " + sentence);
  if (!finding.adequacy.unexplained.empty())
    lines.push_back("  Unexplained: " + remainsOf(finding.adequacy.unexplained) + ".");
  if (!finding.gap) return lines;
  lines.push_back("  " + gainOf(*finding.gap));
  const std::string worse = worseOf(*finding.gap);
  if (!worse.empty()) lines.push_back("  " + worse);
  Points rivals;
  if (finding.verdict == GapVerdict::kAmbiguous) addRivals(finding, rivals);
  for (const std::string& rival : rivals.items) lines.push_back("  " + rival);
  return lines;
}

std::vector<Block> firstBlocks(const GapFinding& finding) {
  std::vector<Block> blocks;
  const std::string words = opening(finding);
  if (!words.empty()) blocks.push_back(Paragraph{words});
  if (const std::string brief = briefWords(finding); !brief.empty())
    blocks.push_back(Paragraph{brief});
  if (finding.search.cut_short) blocks.push_back(Paragraph{kCutShort});
  if (finding.verdict == GapVerdict::kCannotTell && !finding.identified.effects.empty())
    blocks.push_back(Paragraph{kNoResult});
  const Points sentences{sentencesOf(finding)};
  if (!sentences.items.empty()) blocks.push_back(sentences);
  if (!finding.adequacy.unexplained.empty()) {
    blocks.push_back(Paragraph{"Unexplained: " + remainsOf(finding.adequacy.unexplained) + "."});
    if (Pictures rest = restPictures(finding); !rest.svg.empty()) blocks.push_back(rest);
  }
  if (finding.gap) {
    blocks.push_back(Paragraph{gainOf(*finding.gap)});
    const std::string worse = worseOf(*finding.gap);
    if (!worse.empty()) blocks.push_back(Paragraph{worse});
    blocks.push_back(Pictures{{gapPicture(*finding.gap, false), gapPicture(*finding.gap, true)},
                              "End errors on executions that were not used for the fit."});
  }
  const bool unknown = finding.verdict == GapVerdict::kNotInCatalogue && !finding.before.rest;
  blocks.push_back(
      Paragraph{"What to do: " + (unknown ? kUnknownRest : adviceFor(finding.verdict).next)});
  addNext(finding, blocks);
  return blocks;
}

std::string moodOf(GapVerdict verdict) {
  if (exitStatus(verdict) == 0) return "good";
  if (verdict == GapVerdict::kFound || verdict == GapVerdict::kMeasurement) return "change";
  return "doubt";
}

}  // namespace tread::gap
