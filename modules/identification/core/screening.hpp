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

// What rows and their blocks say of a state: losses of blocks left out, covariances, score tests.
namespace tread::gap {

/// Loss of every block when the parameters come from the other blocks (blocks x 1) [nats].
/** Folds of whole blocks; a fold's parameters are those of a linearised refit from the state's
 * optimum without it, so that no simulation is needed. The state's Jacobian must be current. */
Eigen::VectorXd heldOutLoss(const Fitter& fitter, const FitState& state);

/// Lets the free parameters of a state follow its residuals in first order: the prediction changes,
/// the model does not.
void followLinearly(const Fitter& fitter, FitState& state);

/// A difference over blocks and its standard error.
struct Gain {
  double value = 0.0;  ///< [nats]
  double error = 0.0;
};

/// What the second has less than the first, over blocks that count (of a fitter: with such rows).
Gain gainOf(const Eigen::VectorXd& first, const Eigen::VectorXd& second,
            const std::vector<char>& block_counts);
Gain gainOf(const Fitter& fitter, const Eigen::VectorXd& first, const Eigen::VectorXd& second);

/// Covariance of the free parameters from the scatter of the blocks' pulls (free x free).
/** Sandwich over blocks with its small-sample factor; a direction of no information is infinite
 * (a diagonal of 1e12 times the square of its step). */
Eigen::MatrixXd parameterCovariance(const Fitter& fitter, const FitState& state);

/// Covariance of how far the free parameters go from what the model says of them by chance, where
/// that is right (free x free): of blocks that scatter, of how sure the model is of its numbers,
/// and of how a known rest varies; a diagonal is infinite where none says anything.
/** A number that is held by what is known moves only as far as the rows can pull it. */
Eigen::MatrixXd moveCovariance(const Fitter& fitter, const FitState& state);

/// Changes of the free parameters that imitate directions best (free x directions).
/** `metric`: 1 / scale^2 of the rows that count, 0 of others (rows x 1); `shared`: Jacobian^T
 * metric directions. */
Eigen::MatrixXd imitation(const FitState& state, const Eigen::VectorXd& metric,
                          const Eigen::MatrixXd& shared);

/// Whether directions in which a prediction could change would bring it nearer to the measurement.
/** Each column is freed of what the free parameters explain (orthogonal in the metric of the
 * scales: Neyman), its pull is summed block by block, and T = sum / root of the sum of squares. The
 * distribution of the largest |T| over all columns under "nothing is there" comes from giving each
 * block's pull a random sign (wild bootstrap), the same for all columns, so that correlated columns
 * do not count twice. Blocks, not samples: the ground's noise is correlated. What was known of the
 * free parameters counts as one more measurement, with twice the scatter that it says: a direction
 * that they could follow only against it shows in how far they went. A known rest scatters by what
 * it varies from drive to drive, see restVariation(). */
class ScoreTest {
 public:
  /// `directions` rows x candidates.
  ScoreTest(const Fitter& fitter, const FitState& state, const Eigen::MatrixXd& directions);

  Eigen::Index candidates() const { return pulls_.cols(); }
  /// T of a candidate; 0 where it does not change the prediction.
  double score(Eigen::Index candidate) const { return scores_[candidate]; }
  /// Share of the candidate's size that the free parameters cannot imitate, 0..1.
  double uniqueness(Eigen::Index candidate) const { return uniqueness_[candidate]; }
  /// Estimated size, in first order, in the candidate's unit.
  double size(Eigen::Index candidate) const;
  /// What it would gain, in first order [nats].
  double promise(Eigen::Index candidate) const;
  /// Standard error of that size over blocks.
  double sizeError(Eigen::Index candidate) const;
  /// How many blocks excite a candidate: (sum of information)^2 / sum of its squares.
  double activeBlocks(Eigen::Index candidate) const;
  /// How much larger than the scales say the blocks' pulls scatter about one common size; 1 at
  /// least.
  double overdispersion(Eigen::Index candidate) const;
  /// Median of it over the candidates.
  double usualOverdispersion() const;
  /// Size over its standard error from information and overdispersion, not less than the `usual`.
  /** For candidates that few blocks excite: their |T| cannot exceed the root of activeBlocks(). */
  double sparseScore(Eigen::Index candidate, double usual) const;
  /// The same with its own overdispersion alone: Student's t with about activeBlocks() - 1 degrees
  /// of freedom, on the safe side where the scales are too large for what scatters.
  double ownScore(Eigen::Index candidate) const { return sparseScore(candidate, 1.0); }
  /// The candidate freed of what the free parameters explain (rows x 1).
  Eigen::VectorXd own(Eigen::Index candidate) const { return own_.col(candidate); }

  /// Largest |T| over all candidates in each of `draws` draws with nothing there, sorted.
  std::vector<double> largestByChance(int draws, uint64_t seed) const;

 private:
  void weighPrior(const Eigen::MatrixXd& prior, const Eigen::MatrixXd& follow,
                  const Eigen::VectorXd& off);
  double pullOn(Eigen::Index candidate) const;  ///< of all blocks and of what was known
  double rootOf(Eigen::Index candidate) const;  ///< of the sum of squares
  double priorInformation(Eigen::Index candidate) const;

  Eigen::MatrixXd own_;     ///< rows x candidates
  Eigen::MatrixXd pulls_;   ///< blocks x candidates
  Eigen::VectorXd scores_;  ///< candidates
  Eigen::VectorXd uniqueness_;
  Eigen::VectorXd information_;        ///< of a candidate's size, in the rows
  Eigen::MatrixXd block_information_;  ///< blocks x candidates
  Eigen::VectorXd prior_pulls_;        ///< candidates
  Eigen::MatrixXd prior_parts_;        ///< what is known x candidates; squares sum to information
  Eigen::VectorXd variation_;          ///< of a pull, from drive to drive, by a known rest
};

/// What a score must reach to count.
struct Needed {
  double score = 0.0;           ///< |T| that chance rarely reaches
  double overdispersion = 1.0;  ///< as usual in these drives
  bool first = false;           ///< nothing is known yet of what usually scatters and why
  bool size_counts = true;      ///< where few blocks excite it; not for what may begin at any time
};

/// Whether so few blocks excite a candidate that its |T| can hardly reach `score`.
bool isSparse(const ScoreTest& test, Eigen::Index candidate, double score);

/// Evidence for a candidate over what is needed; from 1 on chance is no explanation.
/** |T| over blocks; where few blocks excite it, so that T cannot be large, its size for the
 * information and the overdispersion, if that is clear. Of a first effect the overdispersion is its
 * own, as few blocks tell it: Student's t. */
double evidence(const ScoreTest& test, Eigen::Index candidate, const Needed& needed);

/// Probability that chance gives any of so many candidates that evidence by its size alone
/// (Bonferroni).
double chanceOfSize(double evidence, size_t candidates, bool first = false);

/// Share of chance results that are at least as large (with the observed one counted in).
double familyWise(const std::vector<double>& largest_by_chance, double score);
/// The |T| that chance reaches with a probability of `alpha`.
double criticalScore(const std::vector<double>& largest_by_chance, double alpha);

/// One direction in which an effect that is off could act, and where a fit of it begins; or one in
/// which a given term of the model may have changed (`release`): by little, or, where its slope
/// says nothing because the drive does not reach the given value (limits, thresholds), to another
/// value altogether (`elsewhere`).
struct Candidate {
  std::string effect;
  std::string parameter;  ///< of the effect: the strength that is switched on
  double value = 0.0;     ///< at which it is tried
  double change = 0.0;    ///< that this is from where it does nothing; the direction is the secant
  double since = kNotMeasured;  ///< [s] time of a change from which on it acts; NaN = always
  /// Values that go with it: shapes such as the time of a change.
  std::vector<std::pair<std::string, double>> shapes;
  std::vector<std::string> free;  ///< paths that a fit of this candidate frees
  std::string change_point;       ///< path of the time of a change; empty = none
  bool release = false;           ///< of a given term: what was known of it no longer counts
  bool elsewhere = false;         ///< of a release: begins at `value`, far from what is given

  /// Of the strength.
  std::string path() const { return effect + "." + parameter; }
};

/// The most that a drive demands, in first approximation; limits are probed below it.
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
/** Thresholds and change points get several (their gradient at 0 says nothing). Effects that
 * are another one under a second name are left to their groups. */
std::vector<Candidate> candidatesFor(const ModelDocument& model, const Excitation& excitation);

/// Those of a state, without what it has free already: also effects that are on and held by what is
/// known of them, to be freed; where numbers of the nominal model are free without limits, effects
/// that are the same under another name are left out.
std::vector<Candidate> candidatesFor(const FitState& state, const Excitation& excitation);

/// Those of one effect, even if it is another one under a second name.
std::vector<Candidate> candidatesOf(const std::string& effect, const FitState& state,
                                    const Excitation& excitation);

/// Takes out the candidates of these effects.
void leaveOut(std::vector<Candidate>& candidates, const std::vector<std::string>& effects);

/// A model with the candidate at its trial value.
ModelDocument tried(const ModelDocument& model, const Candidate& candidate);

/// The directions of candidates, rows x candidates.
Eigen::MatrixXd directionsOf(const Fitter& fitter, const FitState& state,
                             const std::vector<Candidate>& candidates);

/// Frees the candidate's parameters in a state, from its trial value scaled by first order.
void addCandidate(const Fitter& fitter, FitState& state, const Candidate& candidate, double size);

/// Whether a size is nothing beside what is typical.
bool isVanishing(const std::string& effect, const std::string& parameter, double size);

/// Whether the time that a search may take is over; it asks between its steps and needs no clock.
using TimeLimit = std::function<bool()>;
inline bool neverOver() {
  return false;
}

/// How a search is done.
struct SearchSettings {
  double alpha =
      0.02;  ///< probability that the first test over the whole catalogue names something wrongly
  double alpha_more = 0.05;  ///< the same of every further test, once something is there
  int draws = 1999;          ///< of the bootstrap
  size_t tried = 4;          ///< effects that are refitted at a time
  size_t most = 8;           ///< effects that are added at most
  bool calibrate = false;    ///< the numbers of the nominal model are free
  bool release = true;       ///< given terms may be other than the model says
  double least_gain = 0.01;  ///< of the end error; less is real but negligible; 0 = none is
  /// A person's last word: in from calibration on, whatever tests say.
  std::vector<std::string> accepted;
  std::vector<std::string> rejected;  ///< never considered
  bool all_sized = false;             ///< ends at once where an accepted one cannot be sized
  uint64_t seed = 1;
  TimeLimit is_over = neverOver;  ///< then a search adds nothing more, prunes and ends
};

/// Directions of candidates that were simulated once and serve again.
/** A direction hardly changes when another effect joins the model, and not at all with the data
 * that a fit looks at: those of the first test serve the halves of a nested evaluation, too. */
class SensitivityCache {
 public:
  /// What the limits of candidates are taken from, measured with the first state.
  const Excitation& excitation(const Fitter& fitter, const FitState& state);

  /// Directions of candidates, rows x candidates; those that are not known are simulated.
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

/// The smallest size of a candidate's effect that would have been seen, in its parameter's unit.
/** `needed`: score from which on an effect is seen, with the power that is wanted. A limit bites or
 * does not, and has no size that shrinks: of a limit it is the gentlest one among the candidates
 * that would have been seen. Infinite where nothing would. */
double detectableSize(const std::vector<Candidate>& candidates, const ScoreTest& test, size_t index,
                      double needed);

/// A test of all candidates against one state, and for each effect the candidate with the largest
/// score.
struct Screening {
  std::vector<Candidate> candidates;
  std::vector<double> scores;
  std::vector<double> sizes;
  std::vector<double> chance;    ///< largest scores where nothing is there, sorted
  std::vector<double> evidence;  ///< over what is needed: above 1 chance is no explanation
  std::vector<double> promise;   ///< gain in first order [nats]
  double alpha = 0.0;            ///< of this test
  bool first = false;            ///< nothing has been found yet
  double overdispersion = 1.0;   ///< as usual over the candidates
  std::vector<size_t> best;      ///< of each effect, largest score first
  std::vector<CandidateTest> tests;
};

/// Tests every candidate for a state, with directions from the cache.
/** `first`: nothing has been found yet, so that what usually scatters is not known. */
Screening screen(const Fitter& fitter, const FitState& state, const SearchSettings& settings,
                 bool first, SensitivityCache& cache);

/// Of each effect beyond chance the most promising candidate; the most promising effects first.
std::vector<size_t> significant(const Screening& screening);

/// Probability of a score by chance: by blocks, or by its size where that was what convinced.
double pValueOf(const Screening& screening, double score, double evidence);

}  // namespace tread::gap
