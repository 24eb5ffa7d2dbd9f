// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <functional>
#include <string>
#include <utility>
#include <vector>

#include <Eigen/Core>

#include "modules/identification/core/finding.hpp"
#include "modules/identification/core/fit.hpp"

// Statistics of rows and their blocks for a state: held-out losses, covariances, score tests.
namespace tread::gap {

/// Loss of every block with parameters from the other blocks (blocks x 1) [nats].
/** Folds are whole blocks; the parameters for a fold come from a linearised refit about the state's
 * optimum without it, so that no simulation is needed. The state's Jacobian must be current. */
Eigen::VectorXd heldOutLoss(const Fitter& fitter, const FitState& state);

/// Moves the free parameters of a state along its residuals in first order: changes the prediction,
/// but not the model.
void followLinearly(const Fitter& fitter, FitState& state);

/// A difference over blocks and its standard error.
struct Gain {
  double value = 0.0;  ///< [nats]
  double error = 0.0;
};

/// First minus second, over blocks that count (for a fitter: with such rows).
Gain gainOf(const Eigen::VectorXd& first, const Eigen::VectorXd& second,
            const std::vector<char>& block_counts);
Gain gainOf(const Fitter& fitter, const Eigen::VectorXd& first, const Eigen::VectorXd& second);

/// Covariance of the free parameters from the scatter of the blocks' pulls (free x free).
/** Sandwich estimator over blocks with its small-sample factor; a direction without information is
 * infinite (a diagonal of 1e12 times the square of its step). */
Eigen::MatrixXd parameterCovariance(const Fitter& fitter, const FitState& state);

/// Covariance of the free parameters' deviation from the model's values if these are right (free x
/// free): from the scatter of blocks, the certainty of the model's numbers, and the variation of a
/// known rest; a diagonal is infinite without any of these.
/** A number with a prior moves only as far as the rows can pull it. */
Eigen::MatrixXd moveCovariance(const Fitter& fitter, const FitState& state);

/// Changes of the free parameters that imitate given directions best (free x directions).
/** `metric`: 1 / scale^2 for rows that count, otherwise 0 (rows x 1); `shared`: Jacobian^T metric
 * directions. */
Eigen::MatrixXd imitation(const FitState& state, const Eigen::VectorXd& metric,
                          const Eigen::MatrixXd& shared);

/// Whether directions of change of a prediction would bring it closer to the measurement.
/** Each column is orthogonalized to the free parameters (in the metric of the scales: Neyman), its
 * pull is summed block by block, and T = sum / root of the sum of squares. The null distribution
 * of the largest |T| over all columns comes from giving each block's pull a random sign (wild
 * bootstrap), the same for all columns, so that correlated columns do not count twice. Blocks, not
 * samples, because the ground's noise is correlated. The prior of the free parameters counts as
 * one more measurement with twice its stated scatter: a direction that they could follow only
 * against the prior shows in their displacement. A known rest adds its variation between drives to
 * the scatter, see restVariation(). */
class ScoreTest {
 public:
  /// `directions` rows x candidates.
  ScoreTest(const Fitter& fitter, const FitState& state, const Eigen::MatrixXd& directions);

  Eigen::Index candidates() const { return pulls_.cols(); }
  /// T of a candidate; 0 if it does not change the prediction.
  double score(Eigen::Index candidate) const { return scores_[candidate]; }
  /// Share of the candidate's size that the free parameters cannot imitate, 0..1.
  double uniqueness(Eigen::Index candidate) const { return uniqueness_[candidate]; }
  /// Estimated size, in first order, in the candidate's unit.
  double size(Eigen::Index candidate) const;
  /// Estimated gain, in first order [nats].
  double promise(Eigen::Index candidate) const;
  /// Standard error of that size over blocks.
  double sizeError(Eigen::Index candidate) const;
  /// Effective number of blocks that excite a candidate: (sum of information)^2 / sum of its
  /// squares.
  double activeBlocks(Eigen::Index candidate) const;
  /// Scatter of the blocks' pulls about one common size, relative to the scales; at least 1.
  double overdispersion(Eigen::Index candidate) const;
  /// Median of it over the candidates.
  double usualOverdispersion() const;
  /// Size divided by its standard error from information and overdispersion, which is at least the
  /// `usual` one.
  /** For candidates excited by few blocks: their |T| cannot exceed the root of activeBlocks(). */
  double sparseScore(Eigen::Index candidate, double usual) const;
  /// The same with its own overdispersion only: Student's t with about activeBlocks() - 1 degrees
  /// of freedom, conservative if the scales exceed the scatter.
  double ownScore(Eigen::Index candidate) const { return sparseScore(candidate, 1.0); }
  /// The candidate orthogonalized to the free parameters (rows x 1).
  Eigen::VectorXd own(Eigen::Index candidate) const { return own_.col(candidate); }

  /// Largest |T| over all candidates in each of `draws` draws of the null distribution, sorted.
  std::vector<double> largestByChance(int draws, uint64_t seed) const;

 private:
  void weighPrior(const Eigen::MatrixXd& prior, const Eigen::MatrixXd& follow,
                  const Eigen::VectorXd& off);
  double pullOn(Eigen::Index candidate) const;  ///< of all blocks and of the prior
  double rootOf(Eigen::Index candidate) const;  ///< of the sum of squares
  double priorInformation(Eigen::Index candidate) const;

  Eigen::MatrixXd own_;     ///< rows x candidates
  Eigen::MatrixXd pulls_;   ///< blocks x candidates
  Eigen::VectorXd scores_;  ///< candidates
  Eigen::VectorXd uniqueness_;
  Eigen::VectorXd information_;        ///< about a candidate's size, in the rows
  Eigen::MatrixXd block_information_;  ///< blocks x candidates
  Eigen::VectorXd prior_pulls_;        ///< candidates
  Eigen::MatrixXd prior_parts_;  ///< priors x candidates; their squares sum to the information
  Eigen::VectorXd variation_;    ///< of a pull, between drives, by a known rest
};

/// Requirements on a score.
struct Needed {
  double score = 0.0;           ///< |T| that chance rarely reaches
  double overdispersion = 1.0;  ///< usual for these drives
  bool first = false;           ///< no effect has been found yet, so the usual scatter is unknown
  bool size_counts = true;  ///< for few exciting blocks; not for effects that may begin at any time
};

/// Whether so few blocks excite a candidate that its |T| can hardly reach `score`.
bool isSparse(const ScoreTest& test, Eigen::Index candidate, double score);

/// Evidence for a candidate relative to the requirement; chance is excluded from 1 on.
/** |T| over blocks; if few blocks excite it, so that T cannot be large, its size relative to
 * information and overdispersion, if that is clear. For a first effect the overdispersion is its
 * own, estimated from few blocks: Student's t. */
double evidence(const ScoreTest& test, Eigen::Index candidate, const Needed& needed);

/// Probability that chance gives any of this many candidates such evidence by its size alone
/// (Bonferroni).
double chanceOfSize(double evidence, size_t candidates, bool first = false);

/// Share of chance results that are at least as large (including the observed one).
double familyWise(const std::vector<double>& largest_by_chance, double score);
/// The |T| that chance reaches with a probability of `alpha`.
double criticalScore(const std::vector<double>& largest_by_chance, double alpha);

/// A direction in which an effect that is off could act, with the start values of its fit; or one
/// in which a given term of the model may have changed (`release`): slightly or, if the slope is
/// uninformative because the drive does not reach the given value (limits, thresholds), to another
/// value altogether (`elsewhere`).
struct Candidate {
  std::string effect;
  std::string parameter;  ///< of the effect: the strength that is switched on
  double value = 0.0;     ///< trial value
  double change = 0.0;    ///< difference from the value without effect; the direction is the secant
  double since = kNotMeasured;  ///< [s] time of a change at which it begins to act; NaN = always
  /// Accompanying values: shapes such as the time of a change.
  std::vector<std::pair<std::string, double>> shapes;
  std::vector<std::string> free;  ///< paths freed by a fit of this candidate
  std::string change_point;       ///< path of the time of a change; empty = none
  bool release = false;           ///< of a given term: its prior no longer counts
  bool elsewhere = false;         ///< of a release: begins at `value`, far from the given one

  /// Of the strength.
  std::string path() const { return effect + "." + parameter; }
};

/// The largest demands of a drive, in first approximation; limits are probed below them.
struct Excitation {
  double track_speed = 0.0;  ///< [m/s] commanded
  double omega = 0.0;        ///< [rad/s]
  double v_omega = 0.0;      ///< [m/s2]
  double begin = 0.0;        ///< [s] first command
  double end = 0.0;          ///< [s] last command
  bool voltage = false;      ///< the battery was measured in every drive
};
Excitation excitationOf(const Observations& data, const ModelDocument& model);

/// All directions of all effects of the catalogue that are off in a model.
/** Thresholds and change points get several (their gradient at 0 is uninformative). Second names of
 * other effects are left to their groups. */
std::vector<Candidate> candidatesFor(const ModelDocument& model, const Excitation& excitation);

/// Those of a state, without the parameters that are already free, but including effects that are
/// on and held by a prior, to be released; if numbers of the nominal model are free without a
/// prior, effects that equal them under another name are left out.
std::vector<Candidate> candidatesFor(const FitState& state, const Excitation& excitation);

/// Those of one effect, even if it is a second name of another one.
std::vector<Candidate> candidatesOf(const std::string& effect, const FitState& state,
                                    const Excitation& excitation);

/// Removes the candidates of these effects.
void leaveOut(std::vector<Candidate>& candidates, const std::vector<std::string>& effects);

/// A model with the candidate at its trial value.
ModelDocument tried(const ModelDocument& model, const Candidate& candidate);

/// The directions of candidates, rows x candidates.
Eigen::MatrixXd directionsOf(const Fitter& fitter, const FitState& state,
                             const std::vector<Candidate>& candidates);

/// Frees the candidate's parameters in a state, starting from its trial value scaled in first
/// order.
void addCandidate(const Fitter& fitter, FitState& state, const Candidate& candidate, double size);

/// Whether a size is negligible compared with the typical one.
bool isVanishing(const std::string& effect, const std::string& parameter, double size);

/// Whether the time limit of a search has passed; polled between its steps, needs no clock of its
/// own.
using TimeLimit = std::function<bool()>;
inline bool neverOver() {
  return false;
}

/// Settings of a search.
struct SearchSettings {
  double alpha = 0.02;       ///< error probability of the first test over the whole catalogue
  double alpha_more = 0.05;  ///< the same for every further test, once an effect was found
  int draws = 1999;          ///< of the bootstrap
  size_t tried = 4;          ///< number of effects refitted at a time
  size_t most = 8;           ///< largest number of effects added
  bool calibrate = false;    ///< the numbers of the nominal model are free
  bool release = true;       ///< given terms may differ from the model
  double least_gain =
      0.01;  ///< of the end error; smaller effects are real but negligible; 0 = none is
  /// Final decision of a person: included from the calibration on, whatever the tests give.
  std::vector<std::string> accepted;
  std::vector<std::string> rejected;  ///< never considered
  bool all_sized = false;             ///< stop at once if an accepted one cannot be sized
  uint64_t seed = 1;
  TimeLimit is_over = neverOver;  ///< if so, the search adds nothing more, prunes and ends
};

/// Directions of candidates that were simulated once and are reused.
/** A direction hardly changes when another effect joins the model, and not at all with the
 * selection of rows: those of the first test also serve the halves of a nested evaluation. */
class SensitivityCache {
 public:
  /// Basis of the candidates' limits, measured with the first state.
  const Excitation& excitation(const Fitter& fitter, const FitState& state);

  /// Directions of candidates, rows x candidates; unknown ones are simulated.
  Eigen::MatrixXd directions(const Fitter& fitter, const FitState& state,
                             const std::vector<Candidate>& candidates);

  /// Simulates some candidates again at a state.
  void renew(const Fitter& fitter, const FitState& state, const std::vector<Candidate>& candidates);

 private:
  struct Entry {
    Candidate candidate;
    Eigen::VectorXd direction;
  };
  Entry* find(const Candidate& candidate);

  bool measured_ = false;
  Excitation excitation_;
  std::vector<Entry> entries_;
};

/// The smallest size of a candidate's effect that would have been detected, in its parameter's
/// unit.
/** `needed`: score at which an effect is detected, with the required power. A limit either acts or
 * does not, so its size cannot shrink: for a limit it is the weakest of the candidates that would
 * have been detected. Infinite if none would. */
double detectableSize(const std::vector<Candidate>& candidates, const ScoreTest& test, size_t index,
                      double needed);

/// A test of all candidates against one state, and the highest-scoring candidate of each effect.
struct Screening {
  std::vector<Candidate> candidates;
  std::vector<double> scores;
  std::vector<double> sizes;
  std::vector<double> chance;    ///< largest scores under the null hypothesis, sorted
  std::vector<double> evidence;  ///< relative to the requirement: above 1 chance is excluded
  std::vector<double> promise;   ///< gain in first order [nats]
  double alpha = 0.0;            ///< of this test
  bool first = false;            ///< no effect has been found yet
  double overdispersion = 1.0;   ///< median over the candidates
  std::vector<size_t> best;      ///< of each effect, largest score first
  std::vector<CandidateTest> tests;
};

/// Tests every candidate for a state, with directions from the cache.
/** `first`: no effect has been found yet, so that the usual scatter is unknown. */
Screening screen(const Fitter& fitter, const FitState& state, const SearchSettings& settings,
                 bool first, SensitivityCache& cache);

/// The most promising candidate of each significant effect, the most promising effects first.
std::vector<size_t> significant(const Screening& screening);

/// p-value of a score: by blocks, or by its size if that was decisive.
double pValueOf(const Screening& screening, double score, double evidence);

}  // namespace tread::gap
