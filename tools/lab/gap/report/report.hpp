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

// Text and pictures of a report: the first screen, the sections after it (empty ones are omitted),
// and the explanations for reading and using it.
namespace tread::gap {

/// The parameter's name without its effect.
std::string lastPart(const std::string& path);

/// Natural unit of a limit; empty for a friction, which is dimensionless.
std::string naturalUnit(const EffectParameter& parameter);

/// Converts the estimate of a reciprocal to the limit itself, with its interval.
/** Returns other estimates unchanged. */
ParameterEstimate naturalEstimate(const ParameterEstimate& estimate);

/// Unit of a natural estimate.
std::string saidUnit(const ParameterEstimate& natural);

/// The interval of an estimate in natural units, or that the drive does not determine it.
std::string saidIntervalOf(const ParameterEstimate& estimate);

/// "limit 1.18 rad/s (1.15 to 1.21 rad/s)".
std::string saidEstimate(const ParameterEstimate& estimate);

/// Title of an effect; other names (forward_gain) are returned unchanged.
std::string titleOf(const std::string& effect);
/// The same up to its first comma.
std::string shortTitleOf(const std::string& effect);
/// Titles of effects, "A, B and C".
std::string titlesOf(const std::vector<std::string>& effects,
                     std::string (*title)(const std::string&) = titleOf);

/// One sentence in workshop language with the effect's numbers and sign.
std::string sentenceOf(const FoundEffect& effect);

/// The same; a term that adds to one of the model is followed by their sum.
std::string sentenceOf(const FoundEffect& effect, const ModelDocument& model);

/// Describes an unnamed term: what it adds, depending on which variable, over which range.
std::string sentenceOf(const UnnamedFinding& found, const ModelDocument& model);

/// Unit of a term's values.
std::string termCurveUnit(const UnnamedTerm& term);

/// Sentences on what wheel speeds, motor currents and battery voltage show about an effect, each
/// with a leading space; empty if none decides.
std::string witnessSentences(const FoundEffect& effect);

/// One sentence per found effect, with its name and its evidence, and one per changed term of the
/// model.
std::vector<std::string> sentencesOf(const GapFinding& finding);

/// Sum of a term and the term of the model that it adds to.
struct Total {
  std::string name;
  double value = 0.0;
  std::string unit;
};

/// The total of a parameter in a model; nullopt if it adds to nothing.
std::optional<Total> totalOf(const std::string& path, const ModelDocument& model);

/// How to check an effect in two minutes, and what its sign may mean.
std::string checkOf(const FoundEffect& effect);

/// Whether an estimate is at the end of its plausible range: then it is no measurement.
bool isAtLimit(const GapFinding& finding, const ParameterEstimate& estimate);

/// Whether a drive does not decide between the two.
inline bool isAsGood(const RunnerUp& runner_up) {
  return runner_up.behind < runner_up.error;
}

/// Effects that this drive does not distinguish from a found one: those of its group, then equally
/// good ones.
std::vector<std::string> rivalsOf(const FoundEffect& effect);

/// Name of an alternative to a found effect, within a sentence.
std::string rivalTitle(const std::string& found, const std::string& other);

/// How to distinguish an effect from its alternatives: from their common group, else from the
/// effect.
std::vector<std::string> waysToTell(const FoundEffect& effect);

/// Two effects that may be confused.
struct RivalPair {
  std::string found;
  std::string other;
  bool grouped = false;  ///< same group: residuals cannot decide
  double behind = 0.0;   ///< [nats] of a runner-up
  double error = 0.0;    ///< [nats]
};

/// Whether another drive may distinguish a pair: members of one group need another kind of
/// measurement.
bool driveMayTell(const RivalPair& pair);

/// All pairs of a finding without duplicates.
std::vector<RivalPair> rivalPairs(const GapFinding& finding);

/// For instance "2 s end-pose error on held-out driving: 0.64 -> 0.45 m, heading 20.5 ->
/// 10.7 deg ...".
std::string gainOf(const Gap& gap);

/// Which of position and heading is worse on held-out driving; empty if neither.
std::string worseOf(const Gap& gap);

/// For instance "the yaw rate residual depends on speed and elapsed time; the along residual on
/// ...".
std::string remainsOf(const std::vector<Unexplained>& rests);

/// A term and its meaning.
struct Word {
  std::string word;
  std::string meaning;
};

/// Technical terms of a report.
const std::vector<Word>& glossary();

/// A verdict, its meaning and the next step.
struct Advice {
  GapVerdict verdict;
  std::string meaning;
  std::string next;
};

/// Meaning of a verdict.
const Advice& adviceFor(GapVerdict verdict);

/// Explains an effect: meaning, equation and parameters, appearance in data, confusable effects,
/// and a check of two minutes.
std::string explanation(const Effect& effect);

/// One line for each effect of the catalogue.
std::string listOfEffects();

/// Text of `tread-gap explain` for a topic: start (from a log to a first run), verdicts (and next
/// steps), words (of the report); nullopt for other names.
std::optional<std::string> topic(const std::string& name);

/// One line for each topic.
std::string listOfTopics();

using report::Chart, report::ChartPoint, report::ChartRange;

/// A residual over a variable, before and after, with 95 % intervals; filled dots are marked cells.
std::string atlasPicture(const AtlasCurve& curve);

/// The curve of an unnamed term with its 95 % band, over the data.
std::string termPicture(const UnnamedTerm& term, const UnnamedFinding& found);

/// Pictures of the largest unexplained residuals; none if all is explained.
report::Pictures restPictures(const GapFinding& finding);

/// Largest |mean| of a map before and after, for a common colour scale.
double largestResidual(const AtlasMap& map);

/// A residual over speed and yaw rate.
std::string mapPicture(const AtlasMap& map, bool after, double full_colour);

/// Draws a path seen from above, ahead is up, with the heading at its end.
void drawPath(Chart& chart, const std::vector<Pose2>& poses, const char* colour, bool dashed);

/// Common range of paths, with equal scales.
ChartRange rangeOf(const std::vector<const std::vector<Pose2>*>& paths);

/// One execution: measured, old and new model, relative to its start.
std::string overlayPicture(const Overlay& overlay, const std::string& title);

/// Error at which the colour scale saturates [m]: the 95 % quantile.
double fullColourOf(const std::vector<PlaceError>& places);

/// End errors at their position in the log's frame.
std::string placePicture(const std::vector<PlaceError>& places, bool after, double full_colour,
                         const std::string& log);

/// Gain of each search step on held-out blocks, with its standard error.
std::string stepsPicture(const std::vector<SearchStep>& ladder);

/// Median end errors before, after and the floor.
std::string gapPicture(const Gap& gap, bool yaw);

using report::Block, report::Commands, report::Page, report::Paragraph, report::Pictures;
using report::Points, report::Section, report::Table;

/// Headline of a report in one line, for instance "Found: Limit of turning power", or "A or B: this
/// drive cannot tell them apart".
std::string headlineOf(const GapFinding& finding);

/// The last lines that find prints, verdict first.
std::vector<std::string> closingLines(const GapFinding& finding);

/// Content of the first screen: sentences, gain, next steps.
std::vector<Block> firstBlocks(const GapFinding& finding);

/// Colour class: good, change or doubt.
std::string moodOf(GapVerdict verdict);

/// An input file of `tread-gap find`.
struct InputFile {
  enum class Role { kModel, kTrain, kTest };
  Role role = Role::kTrain;
  std::string name;    ///< without its folder
  std::string sha256;  ///< 64 hexadecimal digits
};

/// Sections that show where and how well the model holds.
std::vector<Section> evidenceSections(const GapFinding& finding,
                                      const std::vector<InputFile>& inputs);

/// Name and version of this program, for provenance.
std::string toolVersion();

/// The whole report.
Page reportPage(const GapFinding& finding, const std::vector<InputFile>& inputs);

/// A person's decisions on effects before a search.
struct DecisionWords {
  std::vector<std::string> accepted;
  std::vector<std::string> rejected;
  std::string by;
};

/// Decisions on effects of the catalogue, accepted ones first.
/** Throws std::runtime_error with one clear line if an effect is unknown, is accepted and rejected,
 * or is named twice, if a rejected one is in the model, or if a person is named without decisions.
 */
std::vector<EffectDecision> decisionsOf(const DecisionWords& words, const ModelDocument& model);

/// Content of verdict.json; numbers that are not finite become null.
/** Keys: verdict, reason, cut_short, effects [{name, kind, parameters {name: {value, unit, low,
 * high}}, group, runner_up}], calibrated, gap {horizon_s, before, after, floor: {position_m,
 * yaw_rad: {median, rms}}}, unnamed [{name, channel, condition, times, at, values, deviations,
 * gain, gain_error}], moved_terms [name], unexplained [{channel, variable}], not_excited, seed,
 * inputs {model, train, test}. A limit that is stored as its reciprocal appears as inverse_limit
 * and under its natural name. */
nlohmann::ordered_json verdictJson(const GapFinding& finding, const std::vector<InputFile>& inputs);

/// The new model with its provenance: tool, seed, logs, and the number of runs on them.
/** A run increments the model's count if the model names one of the same logs. Only training logs
 * are named, since test logs do not influence the model. Decisions of people are kept on record,
 * but are not applied again. */
ModelDocument newModel(const GapFinding& finding, const std::vector<InputFile>& inputs);

/// Whether a finding has a new model: a drive that does not decide gives none.
bool hasNewModel(const GapFinding& finding);

/// Writes model.yaml (if there is a new model), report.md, report.html and, last, verdict.json into
/// an existing folder.
/** Throws std::runtime_error with one clear line. */
void writeFinding(const std::string& folder, const GapFinding& finding,
                  const std::vector<InputFile>& inputs);

}  // namespace tread::gap
