// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include <nlohmann/json.hpp>

#include "common/report/page.hpp"
#include "common/report/text.hpp"
#include "common/vehicle/effects.hpp"
#include "modules/identification/core/finding.hpp"

// A report's words and pictures, its first screen, the sections behind it (one without blocks is
// left out), and what one must know to read it and to act on it.
namespace tread::gap {

/// The parameter's name without its effect.
std::string lastPart(const std::string& path);

/// Unit in which people say a limit; none for a friction, which is no share.
std::string naturalUnit(const EffectParameter& parameter);

/// An estimate of a reciprocal as people say it: the limit itself, its interval turned over.
/** Others come back as they are. */
ParameterEstimate naturalEstimate(const ParameterEstimate& estimate);

/// Unit in which a natural estimate is said.
std::string saidUnit(const ParameterEstimate& natural);

/// The interval of an estimate, limits as people say them, or that the drive does not show it.
std::string saidIntervalOf(const ParameterEstimate& estimate);

/// "limit 1.18 rad/s (1.15 to 1.21 rad/s)".
std::string saidEstimate(const ParameterEstimate& estimate);

/// Title of an effect; what is no effect (forward_gain) as it is.
std::string titleOf(const std::string& effect);
/// The same up to its first comma.
std::string shortTitleOf(const std::string& effect);
/// Titles of effects, "A, B and C".
std::string titlesOf(const std::vector<std::string>& effects,
                     std::string (*title)(const std::string&) = titleOf);

/// One sentence in the words of the workshop with the effect's numbers and its direction.
std::string sentenceOf(const FoundEffect& effect);

/// The same; of a term that acts on top of what the model had with their sum, too.
std::string sentenceOf(const FoundEffect& effect, const ModelDocument& model);

/// What an unnamed term adds to what, by which condition, and where it was driven.
std::string sentenceOf(const UnnamedFinding& found, const ModelDocument& model);

/// Unit of the values of a term.
std::string termCurveUnit(const UnnamedTerm& term);

/// What wheel speeds, motor currents and battery voltage say of an effect, each as a sentence with
/// a space before it; empty where none says anything.
std::string witnessSentences(const FoundEffect& effect);

/// One such sentence for each effect found, with what its witnesses say, behind its name, and one
/// for each term of the model that has changed.
std::vector<std::string> sentencesOf(const GapFinding& finding);

/// What a term and what it acts on top of make together.
struct Total {
  std::string name;
  double value = 0.0;
  std::string unit;
};

/// The total of a parameter in a model; nothing where it acts on top of nothing.
std::optional<Total> totalOf(const std::string& path, const ModelDocument& model);

/// How to check an effect in two minutes, with what its sign may mean beside.
std::string checkOf(const FoundEffect& effect);

/// Whether an estimate ran to the end of what is plausible: then it is no measurement.
bool isAtLimit(const GapFinding& finding, const ParameterEstimate& estimate);

/// Whether a drive leaves open which of two it is.
inline bool isAsGood(const RunnerUp& runner_up) {
  return runner_up.behind < runner_up.error;
}

/// Effects that this drive cannot tell from a found one (without itself): those of its group, then
/// those that are as good.
std::vector<std::string> rivalsOf(const FoundEffect& effect);

/// What another effect is called beside a found one, within a sentence.
std::string rivalTitle(const std::string& found, const std::string& other);

/// What tells an effect from its rivals: of their common group, else of the effect.
std::vector<std::string> waysToTell(const FoundEffect& effect);

/// Two effects that may be taken for each other.
struct RivalPair {
  std::string found;
  std::string other;
  bool grouped = false;  ///< of the same group: the residuals cannot decide
  double behind = 0.0;   ///< [nats] of a runner-up
  double error = 0.0;    ///< [nats]
};

/// Whether a drive may tell a pair: members of one group want another measurement.
bool driveMayTell(const RivalPair& pair);

/// All pairs of a finding, each once, whichever of the two was found first.
std::vector<RivalPair> rivalPairs(const GapFinding& finding);

/// "2 s end-pose error on driving it has not seen: 0.64 -> 0.45 m, heading 20.5 -> 10.7 deg ...".
std::string gainOf(const Gap& gap);

/// Which of position and heading got worse on driving it has not seen; empty if neither did.
std::string worseOf(const Gap& gap);

/// "the yaw rate residual depends on speed and elapsed time; the along residual on ...".
std::string remainsOf(const std::vector<Unexplained>& rests);

/// A word and what it means here.
struct Word {
  std::string word;
  std::string meaning;
};

/// The words of a report that are not everybody's.
const std::vector<Word>& glossary();

/// A verdict, what it means and what to do then.
struct Advice {
  GapVerdict verdict;
  std::string meaning;
  std::string next;
};

/// What a verdict means.
const Advice& adviceFor(GapVerdict verdict);

/// What an effect is, its equation and parameters, what it looks like, what it is confused with
/// and how to check it in two minutes.
std::string explanation(const Effect& effect);

/// One line for each effect of the catalogue.
std::string listOfEffects();

/// What `tread-gap explain` says beside effects: start (from a log of one's own to a first run),
/// verdicts (what to do after each) and words (of the report); nothing for another name.
std::optional<std::string> topic(const std::string& name);

/// One line for each topic.
std::string listOfTopics();

using report::Chart, report::ChartPoint, report::ChartRange;

/// A residual over a variable, before and after, with 95 % intervals; filled dots are marked cells.
std::string atlasPicture(const AtlasCurve& curve);

/// The curve of an unnamed term with its 95 % band, over what it was made from.
std::string termPicture(const UnnamedTerm& term, const UnnamedFinding& found);

/// The strongest of what is unexplained, drawn; none where all is explained.
report::Pictures restPictures(const GapFinding& finding);

/// The largest |mean| of a map before and after: equal colours need a common scale.
double largestResidual(const AtlasMap& map);

/// A residual over speed and yaw rate.
std::string mapPicture(const AtlasMap& map, bool after, double full_colour);

/// A driven path seen from above, ahead is up, with its heading where it ends.
void drawPath(Chart& chart, const std::vector<Pose2>& poses, const char* colour, bool dashed);

/// The part of the ground that paths need, with equal scales.
ChartRange rangeOf(const std::vector<const std::vector<Pose2>*>& paths);

/// One execution: measured, old and new model, seen from its beginning.
std::string overlayPicture(const Overlay& overlay, const std::string& title);

/// The error from which on places have their full colour: 19 of 20 are below it [m].
double fullColourOf(const std::vector<PlaceError>& places);

/// End errors where they were made, in the frame of the log.
std::string placePicture(const std::vector<PlaceError>& places, bool after, double full_colour,
                         const std::string& log);

/// What each step of the search brought on blocks that were not fitted, with its standard error.
std::string stepsPicture(const std::vector<SearchStep>& ladder);

/// Median end errors before, after and the floor.
std::string gapPicture(const Gap& gap, bool yaw);

using report::Block, report::Commands, report::Page, report::Paragraph, report::Pictures;
using report::Points, report::Section, report::Table;

/// The headline of a report in one line, for instance "Found: Limit of turning power"; where the
/// drive cannot tell, "A or B: this drive cannot tell them apart".
std::string headlineOf(const GapFinding& finding);

/// What find prints at its end, the verdict first.
std::vector<std::string> closingLines(const GapFinding& finding);

/// What stands on the first screen: sentences, gain, what to do next.
std::vector<Block> firstBlocks(const GapFinding& finding);

/// good, change or doubt.
std::string moodOf(GapVerdict verdict);

/// A file that `tread-gap find` has read.
struct InputFile {
  enum class Role { kModel, kTrain, kTest };
  Role role = Role::kTrain;
  std::string name;    ///< without its folder
  std::string sha256;  ///< 64 hexadecimal digits
};

/// Those that show where and how well the model holds.
std::vector<Section> evidenceSections(const GapFinding& finding,
                                      const std::vector<InputFile>& inputs);

/// Name and version of this tool, for provenance.
std::string toolVersion();

/// The whole report.
Page reportPage(const GapFinding& finding, const std::vector<InputFile>& inputs);

/// What a person says of effects before a search.
struct DecisionWords {
  std::vector<std::string> accepted;
  std::vector<std::string> rejected;
  std::string by;
};

/// Decisions on effects of the catalogue, accepted ones first.
/** Throws std::runtime_error with one clear line for a name that the catalogue does not know, for
 * an effect that is accepted and rejected or named twice, for a rejected one that the model has,
 * and for a person who decides nothing. */
std::vector<EffectDecision> decisionsOf(const DecisionWords& words, const ModelDocument& model);

/// What verdict.json holds; numbers that are not finite are null.
/** Keys: verdict, reason, cut_short, effects [{name, kind, parameters {name: {value, unit, low,
 * high}}, group, runner_up}], calibrated, gap {horizon_s, before, after, floor: {position_m,
 * yaw_rad: {median, rms}}}, unnamed [{name, channel, condition, times, at, values, deviations,
 * gain, gain_error}], moved_terms [name], unexplained [{channel, variable}], not_excited, seed,
 * inputs {model, train, test}. A limit that the model holds as its reciprocal stands there as
 * inverse_limit and under its natural name, too. */
nlohmann::ordered_json verdictJson(const GapFinding& finding, const std::vector<InputFile>& inputs);

/// The new model with where it comes from: tool, seed, logs, and how often it was worked on them.
/** A run counts on from the model's own count if it names one of the same logs. Only training logs
 * are named: nothing of the model comes from the others. What people decided stays on record from
 * model to model, but decides nothing by itself. */
ModelDocument newModel(const GapFinding& finding, const std::vector<InputFile>& inputs);

/// Whether a finding has a new model: a drive that cannot tell gives none.
bool hasNewModel(const GapFinding& finding);

/// Writes model.yaml (if there is a new model), report.md, report.html and, last, verdict.json into
/// a folder that is there.
/** Throws std::runtime_error with one clear line. */
void writeFinding(const std::string& folder, const GapFinding& finding,
                  const std::vector<InputFile>& inputs);

}  // namespace tread::gap
