// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <functional>
#include <map>
#include <string>
#include <vector>

#include "modules/identification/core/candidates.hpp"
#include "modules/identification/core/direction_book.hpp"
#include "modules/identification/core/finding.hpp"
#include "modules/identification/core/fit.hpp"
#include "modules/identification/core/score_test.hpp"
#include "modules/identification/core/search_settings.hpp"
#include "modules/identification/core/validation.hpp"

namespace tread::gap {

/// Takes one line about what is being done.
using Progress = std::function<void(const std::string&)>;

/// What a search ends with.
struct SearchResult {
  FitState state;                    ///< of the new model
  FitState calibrated;               ///< of the given terms alone
  std::vector<std::string> effects;  ///< switched on, in the order of acceptance
  std::map<std::string, std::vector<RunnerUp>> runner_ups;
  std::map<std::string, Gain> gains;  ///< what each brings when all others are there
  std::map<std::string, double> scores;
  std::map<std::string, double> evidence;  ///< over what is needed
  std::map<std::string, double> p_values;
  std::vector<LadderStep> ladder;
  std::vector<CandidateTest> tests;  ///< of the calibrated model, every effect's best direction
  std::vector<std::string> negligible;
  std::vector<std::string>
      released;  ///< effects of given terms that are others than the model says
  std::vector<std::string> at_bound;  ///< went since their sizes ran to the ends of their ranges
  std::vector<std::string> accepted;  ///< of the settings: they stay
  std::vector<std::string> rejected;  ///< of the settings: they never come
  std::map<std::string, std::string> unsized;  ///< accepted, but not in: why
  /// Of an effect that stands for two others: those two.
  std::map<std::string, std::vector<std::string>> replaced;
};

/// Directions that searches over the same rows share: of the calibrated model, and of the one with
/// the cover.
struct SearchMemory {
  DirectionBook calibrated;
  DirectionBook covered;
};

/// Which parameters of a model are free: strengths of effects that are on, and the numbers of the
/// nominal model of which the model's covariance says how sure they are; all held by what it says.
/// When calibrating all numbers of the nominal model are free without limits of belief.
std::vector<FreeParameter> givenParameters(const ModelDocument& model, bool calibrate);

/// Finds the effects that a model lacks (gap.md 4.2, stages 1 and 3 to 5), on rows of the mask.
/** 1. Calibrates what is on. 2. Tests all that is off; ends if chance explains it. 3. Else takes in
 * the plain causes (slip, width, lag, delay, latency) as a cover, so that they cannot pass as
 * something rarer, 4. tests, refits the best, validates on blocks left out and adds the best, as
 * long as something is significant, 5. removes what the rest makes superfluous, cover included, and
 * what runs to its bound. Where nothing is left the candidates of step 2 are tried without the
 * cover. Given terms are held by the model's covariance; to let one go (a release) is a candidate
 * like an effect. */
SearchResult search(const Fitter& fitter, const ModelDocument& model, const std::vector<char>& mask,
                    const SearchSettings& settings, SearchMemory& memory, const Progress& say);

/// Refits the structure of a result on other rows, from the result's values.
FitState refitted(const Fitter& fitter, const SearchResult& result, const std::vector<char>& mask);

}  // namespace tread::gap
