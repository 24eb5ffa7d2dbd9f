// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cmath>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "common/vehicle/model.hpp"
#include "modules/identification/core/fit.hpp"

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
  /// The largest |T| that so many blocks allow.
  double mostScore(Eigen::Index candidate) const {
    return std::sqrt(activeBlocks(candidate)) / dependence_;
  }
  /// Scatter of the blocks' pulls about one common size, relative to the scales; at least 1.
  double overdispersion(Eigen::Index candidate) const;
  /// Median of it over the candidates.
  double usualOverdispersion() const;
  /// Size divided by its standard error from information and overdispersion, which is at least the
  /// `usual` one.
  /** For candidates excited by few blocks: their |T| cannot exceed the root of activeBlocks(). */
  double sparseScore(Eigen::Index candidate, double usual) const;
  /// The factor by which blocks scatter more than information says.
  double excessScatter(Eigen::Index candidate, double usual) const;
  /// That standard error.
  double sparseError(Eigen::Index candidate, double usual) const;
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
  double sparseRoot(Eigen::Index candidate, double usual) const;
  double priorInformation(Eigen::Index candidate) const;

  double dependence_;       ///< see Observations
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

inline constexpr double kPowerQuantile = 0.84;  ///< normal: 80 % power

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

/// The same for a fitted candidate, from its gain on held-out blocks [nats]; `test` at the fit.
/** Residuals far beyond the scales hardly pull, so that a large effect shows in its gain. */
double evidenceOfGain(const ScoreTest& test, Eigen::Index candidate, double gain,
                      const Needed& needed);

/// The smallest size of a candidate that such evidence finds with 80 % power if blocks are brief,
/// so that only size counts; infinite if none.
double leastSize(const ScoreTest& test, Eigen::Index candidate, const Needed& needed);

/// Probability that chance gives any of this many candidates such evidence by its size alone
/// (Bonferroni).
double chanceOfSize(double evidence, size_t candidates, bool first = false);

/// Share of chance results that are at least as large (including the observed one).
double familyWise(const std::vector<double>& largest_by_chance, double score);
/// The |T| that chance reaches with a probability of `alpha`.
double criticalScore(const std::vector<double>& largest_by_chance, double alpha);

}  // namespace tread::gap
