// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include "modules/identification/core/finding.hpp"
#include "modules/identification/core/fit.hpp"
#include "modules/identification/core/search.hpp"

// What a drive says of a model, and on what the residuals still depend.
namespace tread::gap {

/// A quantity on which residuals may depend, at each observation.
struct Variable {
  std::string name;  ///< "v", "yaw rate", "v x yaw rate", ...
  std::string unit;
  Eigen::VectorXd values;  ///< rows x 1
};

/// All such quantities, from the simulated motion, the roll and pitch of the INS and the time.
std::vector<Variable> variablesOf(const Observations& data, const ModelDocument& model);

/// Plain conditions of the motion, the commands and what was before, of which the residuals may be
/// some function; speed and yaw rate first.
std::vector<Variable> inputsOf(const Observations& data, const ModelDocument& model);

/// Tests every channel of the residuals for every variable, with the state's free parameters, and
/// for any smooth function of all conditions together.
/** Of the strongest rests it says which effect of the catalogue, on or off, they resemble most in
 * their channel. It is not taken for that effect: its size was free to explain it, or no test, or a
 * person, took it in. The chance of an error is `alpha` over all variables and half of it more for
 * the smooth functions, so that these cost the variables no power; they are told where no variable
 * of their channel is, by the condition that matters most. Where the fitter predicts a rest, both
 * are tested for what is beyond it. */
Adequacy testAdequacy(const Fitter& fitter, const FitState& state, double alpha, uint64_t seed);

/// Where the residuals of two models are: curves of every channel over variables that a person
/// looks at and over those of what is unexplained, and maps over speed and yaw rate.
/** The interval of a curve's cell is from the scatter of its blocks' means; cells that exclude 0
 * after correction for the number of cells (Bonferroni, 5 %) are marked. */
ResidualAtlas residualAtlas(const Observations& observations, const ModelDocument& before,
                            const ModelDocument& after,
                            const std::vector<Unexplained>& unexplained = {});

/// Blocks of measured driving from which chance and cause can be told apart.
inline constexpr int kLeastBlocks = 10;

/// Empty if rows are enough to conclude anything from; else one line that says how much to drive.
std::string tooLittleDriving(const Observations& data);

/// The model that a search ended with: its effects and terms with their 95 % intervals, covariance
/// and envelope, and the effects that the drive could not have shown.
/** `before` is the model that the search began with. */
IdentifiedModel identifiedModel(const Fitter& fitter, const ModelDocument& before,
                                const SearchSettings& settings, const FoundTerms& result);

/// The headline of a finding whose effects, calibrated terms, adequacy and errors are known: one
/// verdict, with its reason where it is kCannotTell.
/** Adequate is a p-value above `adequacy_alpha`. Terms of the model that moved count if the end
 * error falls by more than the share `least_gain`. A search that was cut short is kPartial with
 * what it has found, and kCannotTell if that is nothing. */
void judge(GapFinding& finding, double adequacy_alpha, double least_gain);

/// What `tread-gap find` is asked.
struct GapTask {
  ModelDocument model;
  std::vector<Drive> train;
  std::vector<Drive> test;         ///< never used for structure or parameters; may be empty
  std::vector<LogNote> log_notes;  ///< what is known of the logs
  /// Lag, delay and gains of the nominal model are fitted, too: makes a model of a new vehicle.
  bool calibrate = false;
  /// What is real stays in, however little it changes the end error.
  bool keep_small = false;
  /// What no effect explains is told, and becomes no term of the new model; nor does it where a
  /// person has rejected an effect, which would come back without its name.
  bool named_only = false;
  /// Accepted effects are in the model from the start and stay; rejected ones are never considered.
  std::vector<EffectDecision> decisions;
  uint64_t seed = 1;
  ParallelFor parallel = serialFor;  ///< does not change a bit of the result
  TimeLimit is_over = neverOver;     ///< then the best so far is the result
};

/// Where simulation and measurement disagree, what it is most likely called, how sure that is.
/** Calibrates, tests and selects effects, tests what is left, and measures the error on driving
 * that was used neither for the choice of effects nor for their size: the test drives, or else
 * alternate blocks of the training drives, each half predicted with what the other half found.
 * Deterministic for a seed. Throws std::invalid_argument for an accepted effect that the drives
 * cannot size. */
GapFinding findGap(const GapTask& task, const Progress& say);

}  // namespace tread::gap
