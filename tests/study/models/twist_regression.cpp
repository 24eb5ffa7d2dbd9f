// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tests/study/models/twist_regression.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/Cholesky>

#include "modules/identification/core/screening.hpp"
#include "tests/study/models/twist_pieces.hpp"

namespace tread::gap {
namespace {

constexpr int kFolds = 5;
constexpr int kReweighted = 6;    // iterated least-squares steps per round
constexpr int kMostRounds = 4;    // with new Jacobians
constexpr int kMostHalvings = 5;  // of a step that increases the loss
constexpr double kEnough = 0.5;   // [nats] a round with less gain is the last
constexpr double kStep = 0.05;    // [m/s or rad/s] of differences, root mean square

/// Corrections of all pieces (pieces x 3).
Eigen::MatrixX3d correctionOf(const std::vector<TwistTerm>& terms, const Eigen::MatrixXd& values,
                              const Eigen::VectorXd& coefficients) {
  Eigen::MatrixX3d correction = Eigen::MatrixX3d::Zero(values.rows(), 3);
  for (size_t t = 0; t < terms.size(); ++t) {
    const auto at = static_cast<Eigen::Index>(t);
    correction.col(static_cast<Eigen::Index>(terms[t].part)) += coefficients[at] * values.col(at);
  }
  return correction;
}

class RegressionFit {
 public:
  RegressionFit(const Fitter& fitter, const ModelDocument& model, std::vector<TwistTerm> terms,
                const RegressionSettings& settings)
      : fitter_(fitter),
        data_(fitter.data()),
        ins_(model.measurement),
        mask_(fitter.mask()),
        counts_(fitter.blocksThatCount()),
        pieces_(data_, model.vehicle) {
    result_.terms = std::move(terms);
    if (settings.scaled) result_.scale = pieces_.scaleOf(counts_);
    values_ = pieces_.valuesOf(result_.terms, result_.scale);
    normalise();
  }

  TwistRegression run(const std::vector<double>& deviations) {
    coefficients_ = Eigen::VectorXd::Zero(values_.cols());
    predicted_ = predict(coefficients_);
    renewNoise();
    for (int round = 0; round < kMostRounds; ++round) {
      renewJacobian();
      // The prior's strength is chosen once, so that rounds have the same objective.
      if (round == 0) result_.deviation = bestOf(deviations);
      const double before = lossOf(predicted_, coefficients_);
      if (before - step() < kEnough) break;
      renewNoise();
    }
    result_.coefficients = coefficients_.cwiseQuotient(unit_);
    return std::move(result_);
  }

 private:
  /// Scales columns to a root mean square of 1 over training pieces; columns of zeros stay.
  void normalise() {
    Eigen::VectorXd squares = Eigen::VectorXd::Zero(values_.cols());
    double count = 0.0;
    for (Eigen::Index p = 0; p < values_.rows(); ++p)
      if (counts_[static_cast<size_t>(pieces_.pieces()[static_cast<size_t>(p)].block)]) {
        squares += values_.row(p).cwiseAbs2();
        count += 1.0;
      }
    unit_ = (squares / std::max(1.0, count)).cwiseSqrt();
    for (Eigen::Index t = 0; t < unit_.size(); ++t) {
      if (unit_[t] <= 0.0) unit_[t] = 1.0;
      values_.col(t) /= unit_[t];
    }
  }

  Eigen::VectorXd predict(const Eigen::VectorXd& coefficients) const {
    const auto correction = correctionOf(result_.terms, values_, coefficients);
    return data_.predict(pieces_.motions(correction), ins_);
  }

  void renewNoise() {
    const Eigen::VectorXd activity = activityOf(data_.all(), predicted_);
    const Noise noise = estimateNoise(data_.all(), data_.residuals(predicted_), activity, mask_);
    scales_ = scalesOf(data_.all(), noise, activity);
  }

  void renewJacobian() {
    jacobian_.resize(predicted_.size(), coefficients_.size());
    fitter_.parallel()(static_cast<size_t>(coefficients_.size()), [this](size_t t) {
      const auto at = static_cast<Eigen::Index>(t);
      Eigen::VectorXd changed = coefficients_;
      changed[at] += kStep;
      jacobian_.col(at) = (predict(changed) - predicted_) / kStep;
    });
  }

  double lossOf(const Eigen::VectorXd& predicted, const Eigen::VectorXd& coefficients) const {
    const double prior = 0.5 * coefficients.squaredNorm() / std::pow(result_.deviation, 2);
    return totalLoss(data_.residuals(predicted), scales_, mask_) + prior;
  }

  Eigen::VectorXd weightsAt(const Eigen::VectorXd& residuals) const {
    Eigen::VectorXd weights(residuals.size());
    for (Eigen::Index i = 0; i < residuals.size(); ++i)
      weights[i] = mask_[static_cast<size_t>(i)] ? weightOf(residuals[i], scales_[i]) : 0.0;
    return weights;
  }

  /// Residuals of a linear model without correction, to be explained by the coefficients.
  Eigen::VectorXd aim() const { return data_.residuals(predicted_) + jacobian_ * coefficients_; }

  Eigen::VectorXd solveLinearly(double deviation) const {
    const Eigen::VectorXd target = aim();
    Eigen::VectorXd solved = coefficients_;
    for (int n = 0; n < kReweighted; ++n) {
      const Eigen::VectorXd weights = weightsAt(target - jacobian_ * solved);
      const Eigen::MatrixXd weighted = weights.asDiagonal() * jacobian_;
      Eigen::MatrixXd normal = jacobian_.transpose() * weighted;
      normal.diagonal().array() += 1.0 / (deviation * deviation);
      solved = normal.ldlt().solve(weighted.transpose() * target);
    }
    return solved;
  }

  /// Moves the coefficients; returns the new loss.
  double step() {
    const Eigen::VectorXd old = coefficients_;
    const double before = lossOf(predicted_, old);
    Eigen::VectorXd change = solveLinearly(result_.deviation) - old;
    for (int n = 0; n < kMostHalvings; ++n, change /= 2.0) {
      const Eigen::VectorXd predicted = predict(old + change);
      const double loss = lossOf(predicted, old + change);
      if (!(loss < before)) continue;
      coefficients_ = old + change;
      predicted_ = predicted;
      return loss;
    }
    return before;
  }

  /// Fold of each row, by whole counted blocks; -1 for others.
  std::vector<int> folds() const {
    std::vector<int> of_block(counts_.size(), -1);
    int next = 0;
    for (size_t b = 0; b < counts_.size(); ++b)
      if (counts_[b]) of_block[b] = next++ % kFolds;
    std::vector<int> folds;
    folds.reserve(mask_.size());
    for (size_t i = 0; i < mask_.size(); ++i)
      folds.push_back(mask_[i] ? of_block[static_cast<size_t>(data_.all()[i].block)] : -1);
    return folds;
  }

  /// The deviation with the least loss on left-out blocks, to first order.
  double bestOf(const std::vector<double>& deviations) const {
    if (deviations.size() == 1) return deviations.front();
    const Eigen::VectorXd target = aim();
    // Common weights from a medium fit, so that jumps of the INS do not decide.
    const double middle = deviations[deviations.size() / 2];
    const Eigen::VectorXd weights = weightsAt(target - jacobian_ * solveLinearly(middle));
    const std::vector<int> fold_of_row = folds();
    Eigen::VectorXd losses = Eigen::VectorXd::Zero(static_cast<Eigen::Index>(deviations.size()));
    for (int fold = 0; fold < kFolds; ++fold) {
      Eigen::VectorXd inside = weights;
      for (size_t i = 0; i < fold_of_row.size(); ++i)
        if (fold_of_row[i] == fold) inside[static_cast<Eigen::Index>(i)] = 0.0;
      const Eigen::MatrixXd weighted = inside.asDiagonal() * jacobian_;
      const Eigen::MatrixXd normal = jacobian_.transpose() * weighted;
      const Eigen::VectorXd pull = weighted.transpose() * target;
      for (size_t d = 0; d < deviations.size(); ++d) {
        Eigen::MatrixXd ridge = normal;
        ridge.diagonal().array() += 1.0 / (deviations[d] * deviations[d]);
        const Eigen::VectorXd rest = target - jacobian_ * ridge.ldlt().solve(pull);
        for (size_t i = 0; i < fold_of_row.size(); ++i)
          if (fold_of_row[i] == fold) {
            const auto at = static_cast<Eigen::Index>(i);
            losses[static_cast<Eigen::Index>(d)] += gap::lossOf(rest[at], scales_[at]);
          }
      }
    }
    Eigen::Index best = 0;
    losses.minCoeff(&best);
    return deviations[static_cast<size_t>(best)];
  }

  const Fitter& fitter_;
  const Observations& data_;
  const MeasurementModel ins_;
  const std::vector<char>& mask_;
  const std::vector<char> counts_;  ///< blocks with training rows
  const TwistPieces pieces_;
  TwistRegression result_;
  Eigen::MatrixXd values_;        ///< pieces x terms, columns normalised
  Eigen::VectorXd unit_;          ///< terms x 1: scale of each column
  Eigen::VectorXd coefficients_;  ///< terms x 1, for normalised columns
  Eigen::VectorXd predicted_;     ///< rows x 1
  Eigen::VectorXd scales_;        ///< rows x 1
  Eigen::MatrixXd jacobian_;      ///< rows x terms
};

}  // namespace

TwistRegression fitRegression(const Fitter& fitter, const ModelDocument& model,
                              std::vector<TwistTerm> terms, const RegressionSettings& settings) {
  return RegressionFit(fitter, model, std::move(terms), settings).run(settings.deviations);
}

std::vector<std::vector<MotionSample>> simulateCorrected(const Observations& data,
                                                         const VehicleModel& vehicle,
                                                         const TwistRegression& regression) {
  if (regression.terms.empty()) return data.simulate(vehicle);
  const TwistPieces pieces(data, vehicle);
  const Eigen::MatrixXd values = pieces.valuesOf(regression.terms, regression.scale);
  return pieces.motions(correctionOf(regression.terms, values, regression.coefficients));
}

}  // namespace tread::gap
