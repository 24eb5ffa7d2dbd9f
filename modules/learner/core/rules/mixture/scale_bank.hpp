// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <cmath>
#include <vector>

#include <Eigen/Cholesky>
#include <Eigen/Core>

namespace tread::learner::mixture {

/// A regression whose width is not known: of each of several scales one, weighted by its evidence.
/** Measured are means y of kAxes numbers each, y ~ N(0, sum_b s_b G_b + N), G_b the Gram matrix of
 * the b-th kind of spread, s_b what a scale says of it, N the (diagonal) noise. With K the sum of a
 * scale, its weight is its prior weight times N(y; 0, K + N); predictions are the mixture. */
template <int kAxes, int kKinds>
class ScaleBank {
 public:
  struct Scale {
    std::array<double, kKinds> variance;
    double noise;  ///< [1] factor on N
    double weight;
  };
  using Scales = std::vector<Scale>;
  using Grams = std::array<Eigen::MatrixXd, kKinds>;
  using Cross = std::array<Eigen::Matrix<double, Eigen::Dynamic, kAxes>, kKinds>;
  using Block = Eigen::Matrix<double, kAxes, kAxes>;
  using Blocks = std::array<Block, kKinds>;
  using Vector = Eigen::Matrix<double, kAxes, 1>;

  explicit ScaleBank(const Scales& scales) : scales_(scales) {}

  void regress(const Grams& grams, const Eigen::VectorXd& y, const Eigen::VectorXd& noise) {
    const Eigen::Index n = y.size();
    each_.resize(scales_.size());
    Eigen::ArrayXd evidence(static_cast<Eigen::Index>(scales_.size()));
    for (size_t s = 0; s < scales_.size(); ++s) {
      One& one = each_[s];
      one.factor = Eigen::VectorXd(scales_[s].noise * noise).asDiagonal();
      for (size_t b = 0; b < kKinds; ++b) one.factor += scales_[s].variance[b] * grams[b];
      Eigen::LLT<Eigen::Ref<Eigen::MatrixXd>> decomposed(one.factor);
      one.alpha = decomposed.solve(y);
      double& log = evidence[static_cast<Eigen::Index>(s)];
      log = std::log(scales_[s].weight) - 0.5 * y.dot(one.alpha);
      for (Eigen::Index i = 0; i < n; ++i) log -= std::log(one.factor(i, i));
    }
    const Eigen::ArrayXd weights = (evidence - evidence.maxCoeff()).exp();
    const double total = weights.sum();
    for (size_t b = 0; b < kKinds; ++b) mean_alpha_[b].setZero(n);
    for (size_t s = 0; s < scales_.size(); ++s) {
      each_[s].weight = weights[static_cast<Eigen::Index>(s)] / total;
      for (size_t b = 0; b < kKinds; ++b)
        mean_alpha_[b] += each_[s].weight * scales_[s].variance[b] * each_[s].alpha;
    }
  }

  /// Of what was added to a mean: take(weight, mean, covariance, factor on the noise) for each
  /// scale that weighs more than `least`; `cross` to what was measured, `own` of the mean itself.
  template <class Take>
  void predict(const Cross& cross, const Blocks& own, double least, Take&& take) const {
    Eigen::Matrix<double, Eigen::Dynamic, kAxes> k;
    for (size_t s = 0; s < scales_.size(); ++s) {
      const double weight = each_.empty() ? scales_[s].weight : each_[s].weight;
      if (weight < least) continue;
      Block covariance = scales_[s].variance[0] * own[0];
      for (size_t b = 1; b < kKinds; ++b) covariance += scales_[s].variance[b] * own[b];
      Vector mean = Vector::Zero();
      if (!each_.empty() && each_[s].alpha.size() > 0) {
        k = scales_[s].variance[0] * cross[0];
        for (size_t b = 1; b < kKinds; ++b) k += scales_[s].variance[b] * cross[b];
        mean = k.transpose() * each_[s].alpha;
        each_[s].factor.template triangularView<Eigen::Lower>().solveInPlace(k);
        covariance -= k.transpose() * k;
      }
      take(weight, mean, covariance, scales_[s].noise);
    }
  }

  /// Variance of what was added to each measured mean, known with the noise that was given.
  Eigen::VectorXd doubt(const Eigen::VectorXd& noise, double least) const {
    Eigen::VectorXd doubt = Eigen::VectorXd::Zero(noise.size());
    double total = 0.0;
    for (size_t s = 0; s < each_.size(); ++s) {
      const One& one = each_[s];
      if (one.weight < least) continue;
      const Eigen::ArrayXd N = scales_[s].noise * noise.array();
      const Eigen::MatrixXd inverse = one.factor.template triangularView<Eigen::Lower>().solve(
          Eigen::MatrixXd::Identity(noise.size(), noise.size()));
      doubt +=
          one.weight *
          (N - N.square() * inverse.colwise().squaredNorm().transpose().array()).max(0.0).matrix();
      total += one.weight;
    }
    return doubt / total;
  }

  /// sum over the scales of weight, s_b and (K + N)^-1 y: what a kind of spread adds is its cross
  /// covariance times that.
  const Eigen::VectorXd& meanAlpha(size_t kind) const { return mean_alpha_[kind]; }
  /// Expectation of the factor on the noise.
  double meanNoise() const {
    double mean = 0.0;
    for (size_t s = 0; s < scales_.size(); ++s) mean += weight(s) * scales_[s].noise;
    return mean;
  }
  /// Weights of the scales.
  double weight(size_t scale) const {
    return each_.empty() ? scales_[scale].weight : each_[scale].weight;
  }
  const Scales& scales() const { return scales_; }

 private:
  struct One {
    Eigen::MatrixXd factor;  ///< lower triangle: L of K + N = L L'
    Eigen::VectorXd alpha;   ///< (K + N)^-1 y
    double weight = 0.0;
  };

  Scales scales_;
  std::vector<One> each_;
  std::array<Eigen::VectorXd, kKinds> mean_alpha_;
};

/// Gain and residuals of the velocity.
using VelocityBank = ScaleBank<2, 2>;
/// Gain, residuals and bias of the turn rate.
using YawBank = ScaleBank<1, 3>;

}  // namespace tread::learner::mixture
