// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/study/rivals/rivals.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <Eigen/Cholesky>

#include "modules/identification/core/candidates.hpp"
#include "modules/identification/core/search.hpp"

namespace tread::rivals {
namespace {

using namespace gap;

constexpr int kFolds = 5;
constexpr double kRidge = 0.01;  // relative to a column's size: the library is collinear

/// Whether an effect is indistinguishable from an earlier one in its group.
bool isTwin(const std::string& effect) {
  const std::vector<const ConfoundedGroup*> groups = confoundedGroupsOf(effect);
  return std::any_of(groups.begin(), groups.end(), [&](const ConfoundedGroup* group) {
    const auto first =
        std::find_if(group->members.begin(), group->members.end(), [](const std::string& member) {
          const Effect* known = findEffect(member);
          return known != nullptr && !known->search.second_name;
        });
    return group->named_beside && group->share == nullptr && *first != effect;
  });
}

/// The most promising candidate of each effect. These methods have no change points, use the first
/// of indistinguishable effects, and express a scale of positions as slip and track width.
std::vector<Candidate> oneOfEach(const Fitter& fitter, const FitState& state) {
  std::vector<Candidate> all = candidatesFor(state, excitationOf(fitter.data(), state.model));
  all.erase(std::remove_if(all.begin(), all.end(),
                           [](const Candidate& one) {
                             return one.release || !one.change_point.empty() ||
                                    isTwin(one.effect) || one.effect == "position_scale";
                           }),
            all.end());
  const ScoreTest test(fitter, state, directionsOf(fitter, state, all));
  std::map<std::string, size_t> best;
  for (size_t i = 0; i < all.size(); ++i) {
    const auto known = best.emplace(all[i].effect, i).first;
    if (test.promise(static_cast<Eigen::Index>(i)) >
        test.promise(static_cast<Eigen::Index>(known->second)))
      known->second = i;
  }
  std::vector<Candidate> chosen;
  for (const auto& [effect, index] : best) chosen.push_back(all[index]);
  return chosen;
}

FitState begin(const Fitter& fitter, const ModelDocument& model, bool calibrate) {
  FitState state = fitter.start(model, givenParameters(model, calibrate));
  fitter.fit(state);
  fitter.renewJacobian(state);
  return state;
}

/// Counted blocks of measured driving.
int measuredBlocks(const Fitter& fitter) {
  const std::vector<char> counts = fitter.blocksThatCount();
  return static_cast<int>(std::count(counts.begin(), counts.end(), char{1}));
}

/// Fits everything that is free, finally with the noise of a good fit.
void settle(const Fitter& fitter, FitState& state) {
  fitter.fit(state);
  fitter.renewNoise(state);
  fitter.fit(state);
}

/// Estimates of a state, without names.
Answer answerOf(const FitState& state) {
  Answer answer{state.model, {}, {}};
  for (const FreeParameter& parameter : state.free) answer.estimated.push_back(parameter.path);
  return answer;
}

ParameterEstimate estimateOf(const std::string& path, double value, double half) {
  return {path, unitOf(path), value, value - half, value + half, 0.0};
}

/// Weighted least squares of residuals on columns over the rows of some blocks.
class Regression {
 public:
  Regression(const Fitter& fitter, const FitState& state, const Eigen::MatrixXd& columns)
      : columns_(columns.array().colwise() / state.scales.array()),
        rest_(fitter.data().residuals(state.predicted).cwiseQuotient(state.scales)) {
    for (const Observation& row : fitter.data().all()) blocks_.push_back(row.block);
    // A jump of the INS must not decide, and rows that do not count are excluded.
    for (Eigen::Index i = 0; i < rest_.size(); ++i) {
      const bool counts = fitter.mask()[static_cast<size_t>(i)] != 0;
      const double weight = counts ? std::sqrt(weightOf(rest_[i], 1.0)) : 0.0;
      rest_[i] *= weight;
      columns_.row(i) *= weight;
    }
  }

  /// Coefficients of the chosen columns, 0 for the others; a fold is left out (-1 = none).
  Eigen::VectorXd solve(const std::vector<char>& chosen, int fold) const {
    Eigen::MatrixXd matrix = Eigen::MatrixXd::Zero(columns_.cols(), columns_.cols());
    Eigen::VectorXd pull = Eigen::VectorXd::Zero(columns_.cols());
    for (Eigen::Index i = 0; i < rest_.size(); ++i) {
      if (isOf(i, fold)) continue;
      matrix.noalias() += columns_.row(i).transpose() * columns_.row(i);
      pull += columns_.row(i).transpose() * rest_[i];
    }
    for (Eigen::Index c = 0; c < columns_.cols(); ++c) {
      if (chosen[static_cast<size_t>(c)] != 0) {
        matrix(c, c) *= 1.0 + kRidge;
        if (matrix(c, c) > 0.0) continue;
      }
      matrix.row(c).setZero();
      matrix.col(c).setZero();
      matrix(c, c) = 1.0;
      pull[c] = 0.0;
    }
    return matrix.ldlt().solve(pull);
  }

  /// Share of the residual that each term explains.
  Eigen::VectorXd shares(const Eigen::VectorXd& coefficients) const {
    return columns_.colwise().norm().transpose().cwiseProduct(coefficients).cwiseAbs() /
           std::max(rest_.norm(), 1e-12);
  }

  /// Repeatedly drops terms below the threshold and solves again.
  std::vector<char> thresholded(double threshold, int fold, size_t kept) const {
    std::vector<char> chosen(static_cast<size_t>(columns_.cols()), 1);
    while (true) {
      const Eigen::VectorXd share = shares(solve(chosen, fold));
      bool gone = false;
      for (size_t c = kept; c < chosen.size(); ++c)
        if (chosen[c] != 0 && share[static_cast<Eigen::Index>(c)] < threshold) {
          chosen[c] = 0;
          gone = true;
        }
      if (!gone) return chosen;
    }
  }

  /// Squared error on the blocks of a fold.
  double errorOn(const Eigen::VectorXd& coefficients, int fold) const {
    const Eigen::VectorXd error = rest_ - columns_ * coefficients;
    double sum = 0.0;
    for (Eigen::Index i = 0; i < error.size(); ++i)
      if (isOf(i, fold)) sum += error[i] * error[i];
    return sum;
  }

 private:
  bool isOf(Eigen::Index row, int fold) const {
    return fold >= 0 && blocks_[static_cast<size_t>(row)] % kFolds == fold;
  }

  Eigen::MatrixXd columns_;
  Eigen::VectorXd rest_;
  std::vector<int> blocks_;
};

/// The threshold with the least error on left-out blocks.
double bestThreshold(const Regression& regression, size_t kept) {
  double best = 0.0;
  double least = std::numeric_limits<double>::infinity();
  for (double threshold = 0.01; threshold < 0.7; threshold *= 1.6) {
    double error = 0.0;
    for (int fold = 0; fold < kFolds; ++fold)
      error += regression.errorOn(
          regression.solve(regression.thresholded(threshold, fold, kept), fold), fold);
    if (error >= least) continue;
    least = error;
    best = threshold;
  }
  return best;
}

}  // namespace

Answer allParameters(const Fitter& fitter, const ModelDocument& model, bool calibrate) {
  FitState state = begin(fitter, model, calibrate);
  const std::vector<Candidate> candidates = oneOfEach(fitter, state);
  for (const Candidate& candidate : candidates)
    addCandidate(fitter, state, candidate, 0.1 * candidate.change);
  settle(fitter, state);
  const Eigen::MatrixXd covariance = parameterCovariance(fitter, state);
  const int blocks = measuredBlocks(fitter);
  const double needed =
      studentQuantile(blocks - 1, normalQuantileOf(0.05 / static_cast<double>(candidates.size())));
  Answer answer = answerOf(state);
  for (size_t i = 0; i < state.free.size(); ++i) {
    const std::string& path = state.free[i].path;
    const bool is_ours =
        std::any_of(candidates.begin(), candidates.end(),
                    [&](const Candidate& candidate) { return candidate.path() == path; });
    const auto at = static_cast<Eigen::Index>(i);
    const double error = std::sqrt(covariance(at, at));
    const double value = *findParameter(state.model, path);
    if (is_ours && std::abs(value) > needed * error && !onBound(state.model, state.free[i]))
      answer.parameters.push_back(estimateOf(path, value, studentQuantile(blocks - 1) * error));
  }
  return answer;
}

Answer sparseRegression(const Fitter& fitter, const ModelDocument& model, bool calibrate) {
  const FitState state = begin(fitter, model, calibrate);
  const std::vector<Candidate> candidates = oneOfEach(fitter, state);
  // Terms of the model stay free and are never dropped.
  Eigen::MatrixXd columns(state.predicted.size(),
                          state.jacobian.cols() + static_cast<Eigen::Index>(candidates.size()));
  columns << state.jacobian, directionsOf(fitter, state, candidates);
  const auto kept = static_cast<size_t>(state.jacobian.cols());
  const Regression regression(fitter, state, columns);
  const std::vector<char> chosen =
      regression.thresholded(bestThreshold(regression, kept), -1, kept);
  const Eigen::VectorXd coefficients = regression.solve(chosen, -1);
  // A direction holds near its linearization point: sizes of the remaining terms are fitted in
  // simulation.
  FitState fitted = state;
  for (size_t i = 0; i < candidates.size(); ++i)
    if (chosen[kept + i] != 0)
      addCandidate(fitter, fitted, candidates[i],
                   coefficients[static_cast<Eigen::Index>(kept + i)]);
  settle(fitter, fitted);
  Answer answer = answerOf(fitted);
  for (size_t i = 0; i < candidates.size(); ++i) {
    const std::string path = candidates[i].path();
    if (chosen[kept + i] != 0)
      answer.parameters.push_back(
          estimateOf(path, *findParameter(fitted.model, path), kNotMeasured));
  }
  return answer;
}

}  // namespace tread::rivals
