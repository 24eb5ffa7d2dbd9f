// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "modules/identification/core/screening.hpp"
#include "modules/identification/core/validation.hpp"

namespace tread::gap {

/// Takes one line about what is being done.
using Progress = std::function<void(const std::string&)>;

/// What speaks for an effect that was taken in.
struct EffectEvidence {
  double score = 0.0;             ///< T in the presence of all others
  double evidence = 0.0;          ///< over what is needed, see evidence()
  std::optional<double> p_value;  ///< nothing for a nuisance term that no test has named
  Gain gain;                      ///< what it brings when all others are there
  std::vector<RunnerUp> runner_ups;
  std::vector<std::string> replaced;  ///< the two effects in whose place it is
};

/// What a search ends with.
struct SearchResult {
  FitState state;                                  ///< of the new model
  FitState calibrated;                             ///< of the given terms alone
  std::vector<std::string> effects;                ///< switched on, in the order of acceptance
  std::map<std::string, EffectEvidence> evidence;  ///< by effect
  SearchRecord record;
  std::vector<std::string> released;           ///< effects of given terms that were re-estimated
  std::map<std::string, std::string> unsized;  ///< accepted effects that could not be sized: why
};

/// Sensitivities that searches over the same rows share: of the calibrated model, and of the one
/// with nuisance terms.
struct SearchMemory {
  SensitivityCache calibrated;
  SensitivityCache with_nuisance;
};

/// Which parameters of a model are free: strengths of effects that are on, and the numbers of the
/// nominal model of which the model's covariance says how sure they are; all held by what it says.
/// When calibrating all numbers of the nominal model are free without limits of belief.
std::vector<FreeParameter> givenParameters(const ModelDocument& model, bool calibrate);

/// Finds the effects that a model lacks, on rows of the mask.
/** 1. Calibrates what is on. 2. Tests all that is off; ends if chance explains it. 3. Else frees
 * the plain causes (slip, width, lag, delay, latency) as nuisance terms, so that they cannot pass
 * as something rarer, 4. tests, refits the best, validates on blocks left out and adds the best, as
 * long as something is significant, 5. removes what the rest makes superfluous, nuisance terms
 * included, and what runs to its bound. Where nothing is left the candidates of step 2 are tried
 * without nuisance terms. Given terms are held by the model's covariance; to free a held term is a
 * candidate like an effect. */
SearchResult search(const Fitter& fitter, const ModelDocument& model, const std::vector<char>& mask,
                    const SearchSettings& settings, SearchMemory& memory, const Progress& say);

/// Refits the structure of a result on other rows, from the result's values.
FitState refitted(const Fitter& fitter, const SearchResult& result, const std::vector<char>& mask);

}  // namespace tread::gap
