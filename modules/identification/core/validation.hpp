// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "common/vehicle/model.hpp"
#include "modules/identification/core/fit.hpp"

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

}  // namespace tread::gap
