// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "modules/identification/core/finding.hpp"
#include "modules/identification/core/fit.hpp"
#include "modules/identification/core/search.hpp"

// What a drive reveals about a model, and what the residuals still depend on.
namespace tread::gap {

/// The residuals of two models: curves of every channel over the standard variables and over the
/// unexplained ones, and maps over speed and yaw rate.
/** The interval of a curve's cell is from the scatter of its blocks' means; cells that exclude 0
 * after correction for the number of cells (Bonferroni, 5 %) are marked. */
ResidualAtlas residualAtlas(const Observations& observations, const ModelDocument& before,
                            const ModelDocument& after,
                            const std::vector<Unexplained>& unexplained = {});

/// Fewest blocks of measured driving for a statistical conclusion.
inline constexpr int kLeastBlocks = 10;

/// Empty if the rows suffice for a conclusion; otherwise one line with the amount of driving
/// needed.
std::string tooLittleDriving(const Observations& data);

/// The result of a search as a model: effects and terms with their 95 % intervals, covariance and
/// envelope, and the effects that the drive could not have shown.
/** `before` is the model at the start of the search. */
IdentifiedModel identifiedModel(const Fitter& fitter, const ModelDocument& before,
                                const SearchSettings& settings, const FoundTerms& result);

/// Sets the verdict of a finding from its effects, calibrated terms, adequacy and errors, with the
/// reason for kCannotTell.
/** Adequate means a p-value above `adequacy_alpha`. Moved terms of the model count if the end error
 * falls by more than the share `least_gain`. A search that was cut short is kPartial with its
 * results, and kCannotTell without any. */
void judge(GapFinding& finding, double adequacy_alpha, double least_gain);

/// The task of `tread-gap find`.
struct GapTask {
  ModelDocument model;
  std::vector<Drive> train;
  std::vector<Drive> test;         ///< never used for structure or parameters; may be empty
  std::vector<LogNote> log_notes;  ///< notes on the logs
  /// Also fits lag, delay and gains of the nominal model: makes a model of a new vehicle.
  bool calibrate = false;
  /// Keeps all real effects, however little they change the end error.
  bool keep_small = false;
  /// Deviations that no effect explains are reported but not added to the new model as a term; the
  /// same holds if a person has rejected an effect, which would otherwise return without its name.
  bool named_only = false;
  /// Accepted effects are in the model from the start and are kept; rejected ones are never
  /// considered.
  std::vector<EffectDecision> decisions;
  uint64_t seed = 1;
  ParallelFor parallel = serialFor;  ///< does not change a bit of the result
  TimeLimit is_over = neverOver;     ///< if so, the search returns the best result so far
};

/// Where simulation and measurement disagree, the most probable name of the difference, and its
/// certainty.
/** Calibrates, tests and selects effects, tests the remainder, and measures the error on driving
 * that was used neither for choosing the effects nor for their sizes: the test drives or, without
 * any, alternate blocks of the training drives, each half predicted from the other. Deterministic
 * for a seed. Throws std::invalid_argument for an accepted effect whose size the drives cannot
 * determine. */
GapFinding findGap(const GapTask& task, const Progress& say);

}  // namespace tread::gap
