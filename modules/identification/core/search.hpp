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
  /// Effects that it is confounded with and that the model has, which do not explain this drive.
  std::vector<std::string> told_from;
  bool by_wheels = false;  ///< in the place of one that tests named, because the wheels show it
};

/// What a search ends with.
struct FoundTerms {
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

/// A search under way: what it works with, and what it has found.
struct SearchState {
  const Fitter& fitter;
  const SearchSettings& settings;
  const Progress& say;
  FoundTerms& result;

  const Observations& data() const { return fitter.data(); }
  bool isAccepted(const std::string& effect) const { return contains(settings.accepted, effect); }
  /// Asks for the time, and remembers that it is over.
  bool isCutShort() const {
    if (!result.record.cut_short) result.record.cut_short = settings.is_over();
    return result.record.cut_short;
  }
};

/// Which parameters of a model are free: strengths of effects that are on, and the numbers of the
/// nominal model of which the model's covariance says how sure they are; all held by what it says.
/// When calibrating all numbers of the nominal model are free without limits of belief.
std::vector<FreeParameter> givenParameters(const ModelDocument& model, bool calibrate);

/// Finds the effects that a model lacks, on the fitter's rows.
/** 1. Calibrates what is on. 2. Tests all that is off; ends if chance explains it. 3. Else frees
 * the plain causes (slip, width, lag, delay, latency) as nuisance terms, so that they cannot pass
 * as something rarer, 4. tests, refits the best, validates on blocks left out and adds the best, as
 * long as something is significant, 5. removes what the rest makes superfluous, nuisance terms
 * included, and what runs to its bound. Where nothing is left the candidates of step 2 are tried
 * without nuisance terms. Given terms are held by the model's covariance; to free a held term is a
 * candidate like an effect. It ends: steps 3 and 4 only free paths, each once, of which there are
 * as many as the catalogue and the model have; step 5 only takes effects away, or two for one. */
FoundTerms search(const Fitter& fitter, const ModelDocument& model, const SearchSettings& settings,
                  SearchMemory& memory, const Progress& say);

/// Refits the structure of a result on the fitter's rows, from the result's values.
FitState refitted(const Fitter& fitter, const FoundTerms& result);

// Steps of a search.

/// Switches an effect of the catalogue on in a state and fits all, whatever tests would say.
/** Of several ways in which it could act (thresholds, change points) the most promising one.
 * Returns why the drive cannot size it, and leaves the state as it was; empty if it can. */
std::string takeIn(const Fitter& fitter, FitState& state, const std::string& effect);

/// The state with effects switched off; nothing is refitted.
FitState switchedOff(const Fitter& fitter, const FitState& state,
                     const std::vector<std::string>& effects);

/// The state without an effect, its other parameters refitted, with current Jacobian.
FitState without(const Fitter& fitter, const FitState& state, const std::string& effect);

/// The same in first order and without a simulation; nothing is refitted, the model stays as it
/// was.
FitState withoutLinearly(const Fitter& fitter, const FitState& state, const std::string& effect);

/// Removes effects, weakest first, that the others make superfluous.
/** Each that stays passes the score test alone in the presence of the others (evidence() >= 1),
 * improves blocks left out, and the end error by at least `least_gain` of it (0 = however little);
 * accepted ones stay in any case. Fills evidence and record of the result. */
void pruneEffects(const SearchState& search, const Needed& needed);

/// Puts one effect in the place of two where it explains as much.
/** Search goes step by step and may reach what one effect does by two others: a scale of positions
 * is slip and track width together. Only effects whose signature the found ones can imitate are
 * tried; the pair goes if it is not better on blocks left out by more than a standard error. */
void replacePairs(const SearchState& search);

/// Puts effects of the vehicle in the place of those of the INS that do the same together, unless
/// they explain less: a search that goes step by step takes whichever comes first. True if it did.
bool putVehicleFirst(const SearchState& search);

/// A given term that moved and is free of what was known of it, with how well that was known.
struct MovedTerm {
  std::string path;
  double deviation = 0.0;
};

/// Puts one effect in the place of two changes, of which one at least is a term that moved, where
/// it explains as much; takes that term from the list. True if it did.
bool replaceMoved(const SearchState& search, std::vector<MovedTerm>& moved);

/// Notes of effects that were found which of those that they are confounded with cannot stand in
/// their place: the model has these, and they explain less, whatever size they are given.
void noteToldFrom(const SearchState& search);

/// Whether an effect is a lag between a command and what the INS says of it.
inline bool isLag(const Effect& effect) {
  return effect.search.late_by != LateBy::kNothing;
}

/// Path of the first strength of an effect.
inline std::string primaryPath(const Effect& effect) {
  return effect.name + "." + effect.parameters.front().name;
}

/// Chooses anew which lags there are between command and motion, once the rest is known.
/** A lag of the drive, of the yaw rate, of the speed: a search that goes step by step takes the
 * first one that helps, and bends the others to it. The structures are fitted with everything else;
 * another one takes over if it is better on blocks left out by more than a standard error and 10
 * nats, and one lag takes the place of two if it is not worse by both. True if one did. */
bool chooseLags(const SearchState& search);

/// Rows of every other block: those of `half` (0 or 1) count.
std::vector<char> halfMask(const Observations& data, int half);

/// What a state misses on the other half of the driving when it is fitted to one, summed block by
/// block: position [m] and yaw [rad] at the ends of executions, yaw rate, nats (blocks x 4).
Eigen::MatrixXd missedOnOtherHalves(const Fitter& fitter, const FitState& state,
                                    const Eigen::VectorXd& scales);

/// Takes the effects that were not accepted out of a result unless the end error falls with them,
/// by more than its standard error over blocks, on halves of the driving that the sizes of the
/// effects were not fitted to.
/** Effects of the INS, which may move no pose, may lessen what is left of the yaw rate instead; and
 * where rows show an effect by more than 2.5 standard errors, the ends need not. What is without
 * them is fitted to the same halves. */
void dropUnconfirmed(const SearchState& search);

}  // namespace tread::gap
