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

/// Titles of effects, "A, B and C"; what is no effect (forward_gain) as it is.
std::string titleOf(const std::string& effect);
std::string titlesOf(const std::vector<std::string>& effects,
                     const std::string& last_joint = "and");
/// The same up to the first comma of each title.
std::string shortTitleOf(const std::string& effect);
std::string shortTitlesOf(const std::vector<std::string>& effects,
                          const std::string& last_joint = "and");

/// One sentence in the words of the workshop with the effect's numbers and its direction.
std::string sentenceOf(const FoundEffect& effect);

/// The same; of a term that acts on top of what the model had with their sum, too.
std::string sentenceOf(const FoundEffect& effect, const ModelDocument& model);

/// The same behind the effect's name.
std::string titledSentenceOf(const FoundEffect& effect, const ModelDocument& model);

/// One sentence for each term of the model that has changed.
std::vector<std::string> movedSentences(const Finding& finding);

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

/// Values between which a parameter is plausible; not known where the two are equal.
struct PlausibleRange {
  double min = 0.0;
  double max = 0.0;
};

/// The model file's bounds of a parameter, else the catalogue's.
PlausibleRange plausibleRange(const Finding& finding, const std::string& path);

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

}  // namespace tread::gap
