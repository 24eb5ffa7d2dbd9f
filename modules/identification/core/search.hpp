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

/// Includes an effect of the catalogue in a state and fits everything, whatever tests give.
/** If it can act in several ways (thresholds, change points), uses the most promising one. Returns
 * why the drive cannot determine its size, with the state unchanged; empty on success. */
std::string takeIn(const Fitter& fitter, FitState& state, const std::string& effect);

/// The state with effects switched off; nothing is refitted.
FitState switchedOff(const Fitter& fitter, const FitState& state,
                     const std::vector<std::string>& effects);

/// The state without an effect, with the other parameters refitted and a current Jacobian.
FitState without(const Fitter& fitter, const FitState& state, const std::string& effect);

/// The same in first order, without simulation or refit; the model is not changed.
FitState withoutLinearly(const Fitter& fitter, const FitState& state, const std::string& effect);

/// Removes effects that the others make superfluous, weakest first.
/** Each remaining one passes the score test in the presence of the others (evidence() >= 1),
 * improves held-out blocks, and improves the end error by at least the share `least_gain` (0 = any
 * amount); accepted ones always stay. Fills evidence and record of the result. */
void pruneEffects(const SearchState& search, const Needed& needed);

/// Replaces two effects by one that explains as much.
/** A step-by-step search may imitate one effect by two others: a scale of positions by slip and
 * track width together. Only effects whose signature the found ones can imitate are tried; the
 * pair is replaced unless it is better on held-out blocks by more than a standard error. */
void replacePairs(const SearchState& search);

/// Replaces effects of the INS by effects of the vehicle that together have the same influence,
/// unless they explain less: a step-by-step search takes whichever comes first. True if it did.
bool putVehicleFirst(const SearchState& search);

/// A given term that moved and was freed of its prior, with that prior's certainty.
struct MovedTerm {
  std::string path;
  double deviation = 0.0;
};

/// Replaces two changes, at least one of them a moved term, by one effect that explains as much,
/// and removes that term from the list. True if it did.
bool replaceMoved(const SearchState& search, std::vector<MovedTerm>& moved);

/// Notes for found effects which confounded ones cannot replace them: those that the model has and
/// that explain less at any size.
void noteToldFrom(const SearchState& search);

/// Whether an effect is a lag between a command and its measurement by the INS.
inline bool isLag(const Effect& effect) {
  return effect.search.late_by != LateBy::kNothing;
}

/// Path of the first strength of an effect.
inline std::string primaryPath(const Effect& effect) {
  return effect.name + "." + effect.parameters.front().name;
}

/// Reconsiders the choice of lags between command and motion, once the rest is known.
/** A step-by-step search takes the first lag that helps (of the drive, the yaw rate or the speed),
 * and adapts the others to it. The alternatives are fitted with everything else; one replaces the
 * present choice if it is better on held-out blocks by more than a standard error and 10 nats, and
 * one lag replaces two if it is not worse by both. True if one did. */
bool chooseLags(const SearchState& search);

/// Rows of alternate blocks: those of `half` (0 or 1) count.
std::vector<char> halfMask(const Observations& data, int half);

/// Errors of a state on one half of the driving when fitted to the other, summed block by block:
/// position [m] and yaw [rad] at the ends of executions, yaw rate, nats (blocks x 4).
Eigen::MatrixXd missedOnOtherHalves(const Fitter& fitter, const FitState& state,
                                    const Eigen::VectorXd& scales);

/// Removes effects, except accepted ones, from a result unless the end error falls with them by
/// more than its standard error over blocks, on halves of the driving that were not used for their
/// sizes.
/** INS effects, which may not change any pose, may reduce the yaw rate residual instead; and an
 * effect that the rows show by more than 2.5 standard errors need not improve the ends. The model
 * without them is fitted to the same halves. */
void dropUnconfirmed(const SearchState& search);

}  // namespace tread::gap
