// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/identification/core/validation.hpp"

#include "common/statistics/statistics.hpp"
#include "modules/identification/core/rest.hpp"
#include "modules/identification/core/screening.hpp"

#include <algorithm>
#include <cmath>
#include <random>

#include <Eigen/Eigenvalues>

namespace tread::gap {
namespace {

constexpr int kFolds = 5;
constexpr int kRefits = 3;                 // iterated least squares steps of a linearised refit
constexpr double kLeastEigenvalue = 1e-7;  // of the normal matrix in units of its diagonal
constexpr double kUnknownVariance = 1e12;
constexpr double kFewBlocks =
    1.25;  // few: root of active blocks below this multiple of the critical score
constexpr double kAlmostOne = 0.999;
constexpr double kSparse = 3.9;  // normal quantile: 1e-4
/// The same for a first effect: 1e-3 each. With it 2 of 400 null logs of ten blocks named
/// something.
constexpr double kFirst = 3.3;
constexpr double kLeastActive = 3.0;  // blocks that must excite it
/// Factor on the deviations that a model states for its numbers: they were estimated on some days,
/// and others differ more. Chosen on seed 14; with 1, five of 120 logs without effects got a name.
constexpr double kDaysDiffer = 2.0;
constexpr double kLeastUnique = 0.02;  // below it a column is due to the model's curvature
/// Mean derivative of the pull with respect to the residual, times scale^2: (f + 1) / (f + 3).
constexpr double kInformation = (kFreedom + 1.0) / (kFreedom + 3.0);

/// Fold of each row: whole blocks, counted among those with rows that count.
std::vector<int> foldsOf(const Observations& data, const std::vector<char>& counts) {
  std::vector<int> fold_of_block(counts.size(), 0);
  int next = 0;
  for (size_t b = 0; b < counts.size(); ++b)
    if (counts[b]) fold_of_block[b] = next++ % kFolds;
  std::vector<int> folds;
  folds.reserve(data.all().size());
  for (const Observation& row : data.all())
    folds.push_back(fold_of_block[static_cast<size_t>(row.block)]);
  return folds;
}

/// Change of the parameters when only the rows of `train` count, in first order.
Eigen::VectorXd refitted(const FitState& state, const Eigen::VectorXd& residuals,
                         const std::vector<char>& train) {
  const Eigen::MatrixXd prior = priorPrecision(state);
  const Eigen::VectorXd off = offExpected(state);
  Eigen::VectorXd change = Eigen::VectorXd::Zero(off.size());
  Eigen::VectorXd now = residuals;
  for (int n = 0; n < kRefits; ++n) {
    auto [normal, pull] = normalOf(state, now, train);
    normal += prior;
    normal.diagonal() *= 1.0 + 1e-9;
    for (Eigen::Index i = 0; i < normal.rows(); ++i)
      if (normal(i, i) <= 0.0) normal(i, i) = 1.0;
    pull -= prior * (off + change);
    const Eigen::VectorXd step = normal.ldlt().solve(pull);
    change += step;
    now -= state.jacobian * step;
  }
  return change;
}

}  // namespace

Eigen::MatrixXd imitation(const FitState& state, const Eigen::VectorXd& metric,
                          const Eigen::MatrixXd& shared) {
  if (state.free.empty()) return shared;
  Eigen::MatrixXd normal = state.jacobian.transpose() * metric.asDiagonal() * state.jacobian +
                           priorPrecision(state) / kInformation;
  // A ridge far below the data's rounding separates identical columns.
  normal.diagonal() += 1e-10 * normal.diagonal() +
                       Eigen::VectorXd::Constant(normal.rows(), 1e-12 * normal.trace() + 1e-300);
  return normal.ldlt().solve(shared);
}

Eigen::VectorXd heldOutLoss(const Fitter& fitter, const FitState& state) {
  const Observations& data = fitter.data();
  const std::vector<char>& mask = fitter.mask();
  const Eigen::VectorXd residuals = data.residuals(state.predicted);
  const std::vector<int> folds = foldsOf(data, fitter.blocksThatCount());
  Eigen::VectorXd loss = Eigen::VectorXd::Zero(data.blocks());
  for (int fold = 0; fold < kFolds; ++fold) {
    std::vector<char> train(mask.size());
    for (size_t i = 0; i < mask.size(); ++i) train[i] = mask[i] && folds[i] != fold;
    Eigen::VectorXd outside = residuals;
    if (!state.free.empty()) outside -= state.jacobian * refitted(state, residuals, train);
    for (size_t i = 0; i < mask.size(); ++i)
      if (mask[i] && folds[i] == fold) {
        const auto at = static_cast<Eigen::Index>(i);
        loss[data.all()[i].block] += lossOf(outside[at], state.scales[at]);
      }
  }
  return loss;
}

void followLinearly(const Fitter& fitter, FitState& state) {
  if (state.free.empty()) return;
  const Eigen::VectorXd residuals = fitter.data().residuals(state.predicted);
  state.predicted += state.jacobian * refitted(state, residuals, fitter.mask());
}

Gain gainOf(const Eigen::VectorXd& first, const Eigen::VectorXd& second,
            const std::vector<char>& block_counts) {
  std::vector<double> gains;
  for (size_t b = 0; b < block_counts.size(); ++b)
    if (block_counts[b])
      gains.push_back(first[static_cast<Eigen::Index>(b)] - second[static_cast<Eigen::Index>(b)]);
  Gain gain;
  const auto count = static_cast<double>(gains.size());
  for (double value : gains) gain.value += value;
  if (gains.size() < 2) return gain;
  double squares = 0.0;
  for (double value : gains) squares += std::pow(value - gain.value / count, 2);
  gain.error = std::sqrt(squares * count / (count - 1.0));
  return gain;
}

Gain gainOf(const Fitter& fitter, const Eigen::VectorXd& first, const Eigen::VectorXd& second) {
  Gain gain = gainOf(first, second, fitter.blocksThatCount());
  gain.error *= fitter.data().dependence();
  return gain;
}

namespace {

/// Joint information of the rows about the free parameters.
struct Curvature {
  Eigen::MatrixXd rows;     ///< information of the rows alone (free x free)
  Eigen::MatrixXd scatter;  ///< of the blocks' pulls, with the small-sample factor
  Eigen::MatrixXd inverse;  ///< of information plus prior, without directions that have neither
  std::vector<char> lost;   ///< parameters in such directions
  /// Variance of each from the variation of a known rest, with all others fixed: what two of them
  /// share is as well known with a rest as without (free x 1).
  Eigen::VectorXd by_rest;
};

Curvature curvatureOf(const Fitter& fitter, const FitState& state, const Eigen::MatrixXd& prior) {
  const Observations& data = fitter.data();
  const auto count = static_cast<Eigen::Index>(state.free.size());
  const Eigen::VectorXd residuals = data.residuals(state.predicted);
  Eigen::MatrixXd pulls = Eigen::MatrixXd::Zero(data.blocks(), count);
  Eigen::VectorXd metric = Eigen::VectorXd::Zero(residuals.size());
  for (Eigen::Index i = 0; i < residuals.size(); ++i) {
    if (!fitter.mask()[static_cast<size_t>(i)]) continue;
    metric[i] = kInformation / (state.scales[i] * state.scales[i]);
    pulls.row(data.all()[static_cast<size_t>(i)].block) +=
        pullOf(residuals[i], state.scales[i]) * state.jacobian.row(i);
  }
  Curvature of;
  of.rows = state.jacobian.transpose() * metric.asDiagonal() * state.jacobian;
  of.scatter = std::pow(data.dependence(), 2) * pulls.transpose() * pulls;
  const auto counts = fitter.blocksThatCount();
  const auto blocks = static_cast<double>(std::count(counts.begin(), counts.end(), char{1}));
  if (blocks > 1.0) of.scatter *= blocks / (blocks - 1.0);
  const Eigen::MatrixXd all = of.rows + prior;
  // In units of each diagonal, so that metres and seconds are comparable.
  Eigen::VectorXd unit(count);
  for (Eigen::Index i = 0; i < count; ++i)
    unit[i] = all(i, i) > 0.0 ? 1.0 / std::sqrt(all(i, i)) : 1.0;
  const Eigen::MatrixXd scaled = unit.asDiagonal() * all * unit.asDiagonal();
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(scaled);
  Eigen::VectorXd inverse(count);
  Eigen::VectorXd lost = Eigen::VectorXd::Zero(count);
  for (Eigen::Index i = 0; i < count; ++i) {
    const bool known = eigen.eigenvalues()[i] > kLeastEigenvalue;
    inverse[i] = known ? 1.0 / eigen.eigenvalues()[i] : 0.0;
    if (!known) lost += eigen.eigenvectors().col(i).cwiseAbs2();
  }
  of.inverse = unit.asDiagonal() * eigen.eigenvectors() * inverse.asDiagonal() *
               eigen.eigenvectors().transpose() * unit.asDiagonal();
  for (Eigen::Index i = 0; i < count; ++i) of.lost.push_back(lost[i] > 1e-3);
  of.by_rest = (state.jacobian.cwiseAbs2().transpose() * restVariation(fitter, state))
                   .cwiseProduct(unit.cwiseProduct(unit).cwiseAbs2());
  return of;
}

}  // namespace

Eigen::MatrixXd parameterCovariance(const Fitter& fitter, const FitState& state) {
  if (state.free.empty()) return {};
  const Eigen::MatrixXd prior = priorPrecision(state);
  const Curvature of = curvatureOf(fitter, state, prior);
  Eigen::MatrixXd covariance = of.inverse * (of.scatter + prior) * of.inverse;
  covariance.diagonal() += of.by_rest;
  for (size_t i = 0; i < of.lost.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    if (of.lost[i]) covariance(at, at) += kUnknownVariance * std::pow(state.free[i].step, 2);
  }
  return covariance;
}

Eigen::MatrixXd moveCovariance(const Fitter& fitter, const FitState& state) {
  if (state.free.empty()) return {};
  const Curvature of = curvatureOf(fitter, state, priorPrecision(state));
  FitState known = state;
  // A vehicle with a rest does not have the model's form, so that its terms vary more, too.
  const double differ = state.model.rest && !state.model.rest->empty() ? kDaysDiffer : 1.0;
  for (FreeParameter& parameter : known.free)
    if (!restTermOf(parameter.path))
      parameter.deviation = differ * knownDeviation(state.model, parameter.path);
  // A vehicle as described by the model deviates this much from its best numbers, and the rows pull
  // towards it.
  const Eigen::MatrixXd pull = of.scatter + of.rows * priorCovariance(known) * of.rows.transpose();
  Eigen::MatrixXd moves = of.inverse * pull * of.inverse;
  moves.diagonal() = moves.diagonal().cwiseMax(0.0) + of.by_rest;
  for (size_t i = 0; i < of.lost.size(); ++i) {
    const auto at = static_cast<Eigen::Index>(i);
    if (of.lost[i]) moves(at, at) = std::numeric_limits<double>::infinity();
  }
  return moves;
}

ScoreTest::ScoreTest(const Fitter& fitter, const FitState& state, const Eigen::MatrixXd& directions)
    : dependence_(fitter.data().dependence()) {
  const Observations& data = fitter.data();
  const Eigen::VectorXd residuals = data.residuals(state.predicted);
  Eigen::VectorXd metric(residuals.size());
  Eigen::VectorXd pull(residuals.size());
  for (Eigen::Index i = 0; i < residuals.size(); ++i) {
    const bool counts = fitter.mask()[static_cast<size_t>(i)];
    metric[i] = counts ? 1.0 / (state.scales[i] * state.scales[i]) : 0.0;
    pull[i] = counts ? pullOf(residuals[i], state.scales[i]) : 0.0;
  }
  Eigen::MatrixXd follow(0, directions.cols());
  own_ = directions;
  if (!state.free.empty()) {
    const Eigen::MatrixXd weighted = metric.asDiagonal() * directions;
    follow = imitation(state, metric, state.jacobian.transpose() * weighted);
    own_ -= state.jacobian * follow;
  }
  const Eigen::Index count = directions.cols();
  pulls_ = Eigen::MatrixXd::Zero(std::max(1, data.blocks()), count);
  block_information_ = pulls_;
  for (Eigen::Index i = 0; i < residuals.size(); ++i)
    if (metric[i] > 0.0) {
      const int block = data.all()[static_cast<size_t>(i)].block;
      pulls_.row(block) += pull[i] * own_.row(i);
      block_information_.row(block) += kInformation * metric[i] * own_.row(i).cwiseAbs2();
    }
  variation_ = own_.cwiseAbs2().transpose() * restVariation(fitter, state);
  weighPrior(priorPrecision(state) / (kDaysDiffer * kDaysDiffer), follow, offExpected(state));
  scores_ = Eigen::VectorXd::Zero(count);
  uniqueness_ = Eigen::VectorXd::Zero(count);
  information_ = Eigen::VectorXd::Zero(count);
  for (Eigen::Index c = 0; c < count; ++c) {
    const double whole = directions.col(c).cwiseAbs2().dot(metric);
    const double own = own_.col(c).cwiseAbs2().dot(metric);
    if (whole <= 0.0 || own <= kLeastUnique * kLeastUnique * whole) {
      pulls_.col(c).setZero();
      block_information_.col(c).setZero();
      prior_pulls_[c] = 0.0;
      variation_[c] = 0.0;
      prior_parts_.col(c).setZero();
      continue;
    }
    uniqueness_[c] = std::min(1.0, std::sqrt((own + priorInformation(c) / kInformation) / whole));
    information_[c] = kInformation * own;
    const double root = rootOf(c);
    if (root > 0.0) scores_[c] = pullOn(c) / root;
  }
}

void ScoreTest::weighPrior(const Eigen::MatrixXd& prior, const Eigen::MatrixXd& follow,
                           const Eigen::VectorXd& off) {
  prior_pulls_ = follow.transpose() * (prior * off);
  std::vector<Eigen::Index> known;
  for (Eigen::Index i = 0; i < prior.rows(); ++i)
    if (prior(i, i) > 0.0) known.push_back(i);
  prior_parts_ = Eigen::MatrixXd::Zero(static_cast<Eigen::Index>(known.size()), follow.cols());
  if (known.empty()) return;
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(prior);
  // The largest ones; the others are zero.
  const Eigen::Index skipped = prior.rows() - prior_parts_.rows();
  for (Eigen::Index i = 0; i < prior_parts_.rows(); ++i)
    prior_parts_.row(i) = std::sqrt(std::max(0.0, eigen.eigenvalues()[skipped + i])) *
                          (eigen.eigenvectors().col(skipped + i).transpose() * follow);
}

double ScoreTest::pullOn(Eigen::Index candidate) const {
  return pulls_.col(candidate).sum() + prior_pulls_[candidate];
}

double ScoreTest::priorInformation(Eigen::Index candidate) const {
  return prior_parts_.col(candidate).squaredNorm();
}

double ScoreTest::rootOf(Eigen::Index candidate) const {
  return std::sqrt(dependence_ * dependence_ * pulls_.col(candidate).squaredNorm() +
                   priorInformation(candidate) + variation_[candidate]);
}

double ScoreTest::size(Eigen::Index candidate) const {
  const double information = information_[candidate] + priorInformation(candidate);
  return information > 0.0 ? pullOn(candidate) / information : 0.0;
}

double ScoreTest::promise(Eigen::Index candidate) const {
  return 0.5 * size(candidate) * pullOn(candidate);
}

double ScoreTest::sizeError(Eigen::Index candidate) const {
  if (information_[candidate] <= 0.0) return std::numeric_limits<double>::infinity();
  return rootOf(candidate) / (information_[candidate] + priorInformation(candidate));
}

double ScoreTest::activeBlocks(Eigen::Index candidate) const {
  const double squares = block_information_.col(candidate).squaredNorm();
  return squares > 0.0 ? std::pow(information_[candidate], 2) / squares : 0.0;
}

double ScoreTest::overdispersion(Eigen::Index candidate) const {
  if (information_[candidate] <= 0.0) return 1.0;
  const double common = size(candidate);
  double scatter = 0.0;
  for (Eigen::Index b = 0; b < pulls_.rows(); ++b) {
    const double information = block_information_(b, candidate);
    // The block's own influence on the common size is subtracted.
    const double rest = std::max(0.05, 1.0 - information / information_[candidate]);
    scatter += std::pow(pulls_(b, candidate) - common * information, 2) / rest;
  }
  return std::max(1.0, scatter / information_[candidate]);
}

double ScoreTest::usualOverdispersion() const {
  std::vector<double> all;
  for (Eigen::Index c = 0; c < candidates(); ++c)
    if (information_[c] > 0.0) all.push_back(overdispersion(c));
  return quantileOf(std::move(all), 0.5, 1.0);
}

double ScoreTest::excessScatter(Eigen::Index candidate, double usual) const {
  return dependence_ * dependence_ * std::max(usual, overdispersion(candidate));
}

double ScoreTest::sparseRoot(Eigen::Index candidate, double usual) const {
  const double scatter = information_[candidate] * excessScatter(candidate, usual);
  return std::sqrt(scatter + priorInformation(candidate) + variation_[candidate]);
}

double ScoreTest::sparseScore(Eigen::Index candidate, double usual) const {
  if (information_[candidate] <= 0.0) return 0.0;
  return pullOn(candidate) / sparseRoot(candidate, usual);
}

double ScoreTest::sparseError(Eigen::Index candidate, double usual) const {
  if (information_[candidate] <= 0.0) return std::numeric_limits<double>::infinity();
  return sparseRoot(candidate, usual) / (information_[candidate] + priorInformation(candidate));
}

std::vector<double> ScoreTest::largestByChance(int draws, uint64_t seed) const {
  std::mt19937_64 random(seed);
  std::normal_distribution<double> normal;
  Eigen::MatrixXd normalised(pulls_.rows() + prior_parts_.rows(), pulls_.cols());
  normalised << pulls_, prior_parts_;
  Eigen::RowVectorXd varies = variation_.cwiseSqrt().transpose();
  for (Eigen::Index c = 0; c < normalised.cols(); ++c) {
    const double root = std::hypot(normalised.col(c).norm(), varies[c]);
    if (!(root > 0.0)) continue;
    normalised.col(c) /= root;
    varies[c] /= root;
  }
  const bool any_varies = varies.size() > 0 && varies.maxCoeff() > 0.0;
  std::vector<double> largest;
  largest.reserve(static_cast<size_t>(draws));
  Eigen::RowVectorXd sign(normalised.rows());
  for (int draw = 0; draw < draws; ++draw) {
    for (Eigen::Index b = 0; b < pulls_.rows(); ++b) sign[b] = (random() >> 63U) != 0U ? 1.0 : -1.0;
    for (Eigen::Index i = pulls_.rows(); i < sign.size(); ++i) sign[i] = normal(random);
    Eigen::RowVectorXd scores = sign * normalised;
    if (any_varies)
      for (Eigen::Index c = 0; c < scores.size(); ++c) scores[c] += varies[c] * normal(random);
    largest.push_back(scores.size() > 0 ? scores.cwiseAbs().maxCoeff() : 0.0);
  }
  std::sort(largest.begin(), largest.end());
  return largest;
}

bool isSparse(const ScoreTest& test, Eigen::Index candidate, double score) {
  return test.mostScore(candidate) < kFewBlocks * score;
}

double evidence(const ScoreTest& test, Eigen::Index candidate, const Needed& needed) {
  double by_blocks = std::abs(test.score(candidate)) / needed.score;
  // If few blocks act, chance reaches the largest possible score: equalling it is no evidence.
  if (by_blocks < 1.0 + 1e-9) by_blocks = std::min(by_blocks, kAlmostOne);
  if (!needed.size_counts || !isSparse(test, candidate, needed.score)) return by_blocks;
  if (needed.first && test.activeBlocks(candidate) < kLeastActive) return by_blocks;
  const double by_size =
      needed.first ? std::abs(test.ownScore(candidate)) /
                         studentQuantile(test.activeBlocks(candidate) - 1.0, kFirst)
                   : std::abs(test.sparseScore(candidate, needed.overdispersion)) / kSparse;
  return std::max(by_blocks, by_size);
}

namespace {

/// Size of a candidate, in its standard errors, that chance rarely reaches; infinite if none is
/// evidence.
double neededSize(const ScoreTest& test, Eigen::Index candidate, const Needed& needed) {
  if (!needed.size_counts || (needed.first && test.activeBlocks(candidate) < kLeastActive))
    return std::numeric_limits<double>::infinity();
  return needed.first ? studentQuantile(test.activeBlocks(candidate) - 1.0, kFirst) : kSparse;
}

}  // namespace

double evidenceOfGain(const ScoreTest& test, Eigen::Index candidate, double gain,
                      const Needed& needed) {
  const double usual = needed.first ? 1.0 : needed.overdispersion;
  const double scatter = test.excessScatter(candidate, usual);
  return std::sqrt(2.0 * std::max(0.0, gain) / scatter) / neededSize(test, candidate, needed);
}

double leastSize(const ScoreTest& test, Eigen::Index candidate, const Needed& needed) {
  return (neededSize(test, candidate, needed) + kPowerQuantile) *
         test.sparseError(candidate, needed.first ? 1.0 : needed.overdispersion);
}

double chanceOfSize(double evidence, size_t candidates, bool first) {
  return std::min(
      1.0, static_cast<double>(candidates) * chanceBeyond(evidence * (first ? kFirst : kSparse)));
}

double familyWise(const std::vector<double>& largest_by_chance, double score) {
  const auto from =
      std::lower_bound(largest_by_chance.begin(), largest_by_chance.end(), std::abs(score) - 1e-12);
  const auto larger = static_cast<double>(std::distance(from, largest_by_chance.end()));
  return (larger + 1.0) / (static_cast<double>(largest_by_chance.size()) + 1.0);
}

double criticalScore(const std::vector<double>& largest_by_chance, double alpha) {
  if (largest_by_chance.empty()) return std::numeric_limits<double>::infinity();
  const auto at =
      static_cast<size_t>(std::ceil((1.0 - alpha) * static_cast<double>(largest_by_chance.size())));
  return largest_by_chance[std::min(at, largest_by_chance.size() - 1)];
}

}  // namespace tread::gap
