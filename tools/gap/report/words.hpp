// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "common/report/text.hpp"
#include "common/vehicle/effects.hpp"
#include "modules/identification/core/finding.hpp"

namespace tread::gap {

/// The parameter's name without its effect.
std::string lastPart(const std::string& path);

/// Unit in which people say a limit; none for a friction, which is no share.
std::string naturalUnit(const EffectParameter& parameter);

/// An estimate of a reciprocal as people say it: the limit itself, its interval turned over.
/** Others come back as they are. */
Estimate naturalEstimate(const Estimate& estimate);

/// Unit in which a natural estimate is said.
std::string saidUnit(const Estimate& natural);

/// "limit 1.18 rad/s (1.15 to 1.21 rad/s)".
std::string saidEstimate(const Estimate& estimate);

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

/// One such sentence for each effect found, behind its name, and one for each term of the model
/// that has changed.
std::vector<std::string> sentencesOf(const Finding& finding);

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
bool isAtLimit(const Finding& finding, const Estimate& estimate);

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
std::vector<RivalPair> rivalPairs(const Finding& finding);

/// "2 s end-pose error on driving it has not seen: 0.64 -> 0.45 m, heading 20.5 -> 10.7 deg ...".
std::string gainOf(const Gap& gap);

/// Which of position and heading got worse on driving it has not seen; empty if neither did.
std::string worseOf(const Gap& gap);

/// "the yaw rate residual depends on speed and elapsed time; the along residual on ...".
std::string remainsOf(const std::vector<Unexplained>& rests);

}  // namespace tread::gap
