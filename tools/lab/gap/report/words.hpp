// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/vehicle/effects.hpp"
#include "common/vehicle/model_document.hpp"
#include "common/vehicle/unnamed_terms.hpp"
#include "modules/identification/core/finding.hpp"

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

}  // namespace tread::gap
