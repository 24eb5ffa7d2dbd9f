// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "modules/identification/core/screening.hpp"

namespace tread::gap {

/// Receives one line about the current step.
using Progress = std::function<void(const std::string&)>;

/// Evidence for an effect that was included.
struct EffectEvidence {
  double score = 0.0;             ///< T in the presence of all others
  double evidence = 0.0;          ///< relative to the requirement, see evidence()
  std::optional<double> p_value;  ///< nullopt for a nuisance term that no test has named
  Gain gain;                      ///< its contribution when all others are present
  std::vector<RunnerUp> runner_ups;
  std::vector<std::string> replaced;  ///< the two effects that it replaces
  /// Confounded effects that the model has and that do not explain this drive.
  std::vector<std::string> told_from;
  bool by_wheels = false;  ///< replaces one that tests named, because the wheels show it
};

/// Result of a search.
struct FoundTerms {
  FitState state;                                  ///< of the new model
  FitState calibrated;                             ///< of the given terms alone
  std::vector<std::string> effects;                ///< found, in the order of acceptance
  std::map<std::string, EffectEvidence> evidence;  ///< by effect
  SearchRecord record;
  std::vector<std::string> released;           ///< effects of given terms that were re-estimated
  std::map<std::string, std::string> unsized;  ///< accepted effects whose size is undetermined: why
};

/// Sensitivities shared by searches over the same rows: of the calibrated model, and of the one
/// with nuisance terms.
struct SearchMemory {
  SensitivityCache calibrated;
  SensitivityCache with_nuisance;
};

/// A running search: its tools and results.
struct SearchState {
  const Fitter& fitter;
  const SearchSettings& settings;
  const Progress& say;
  FoundTerms& result;

  const Observations& data() const { return fitter.data(); }
  bool isAccepted(const std::string& effect) const { return contains(settings.accepted, effect); }
  /// Polls the time limit, and remembers when it has passed.
  bool isCutShort() const {
    if (!result.record.cut_short) result.record.cut_short = settings.is_over();
    return result.record.cut_short;
  }
};

/// The free parameters of a model: strengths of effects that are on, and numbers of the nominal
/// model that are in its covariance; all have priors from the model. When calibrating, all numbers
/// of the nominal model are free without priors.
std::vector<FreeParameter> givenParameters(const ModelDocument& model, bool calibrate);

/// Finds the effects that a model lacks, on the fitter's rows.
/** 1. Calibrates the effects that are on. 2. Tests all that are off; ends if chance explains the
 *    result. 3. Otherwise frees the common causes (slip, width, lag, delay, latency) as nuisance
 *    terms, so that they cannot pass as rarer ones, 4. tests, refits the best, validates on
 *    held-out blocks and adds the best, while any is significant, 5. removes effects that the
 *    others make superfluous, nuisance terms included, and those that run to a bound. If none is
 *    left, the candidates of step 2 are tried without nuisance terms. Given terms have priors from
 *    the model's covariance; releasing one is a candidate like an effect. Termination: steps 3 and
 *    4 only free paths, each once, of the finite number in catalogue and model; step 5 only
 *    removes effects, or replaces two by one. */
FoundTerms search(const Fitter& fitter, const ModelDocument& model, const SearchSettings& settings,
                  SearchMemory& memory, const Progress& say);

/// Refits the structure of a result on the fitter's rows, starting from the result's values.
FitState refitted(const Fitter& fitter, const FoundTerms& result);

// Steps of a search.

/// Whether an effect is a lag between a command and its measurement by the INS.
inline bool isLag(const Effect& effect) {
  return effect.search.late_by != LateBy::kNothing;
}

/// Path of the first strength of an effect.
inline std::string primaryPath(const Effect& effect) {
  return effect.name + "." + effect.parameters.front().name;
}

}  // namespace tread::gap
