// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

namespace tread::learner {

/// A regression whose width is not known: of each of several scales one, weighted by its evidence.
/** Measured are means y of kAxes numbers each, y ~ N(0, sum_b s_b G_b + N), G_b the Gram matrix of
 * the b-th kind of spread, s_b what a scale says of it, N the (diagonal) noise. With K the sum of a
 * scale, its weight is its prior weight times N(y; 0, K + N); predictions are the mixture.
 * Scales are computed eight at a time, one in each lane of an array: the systems are small, and one
 * after the other most of the time would go into their set-up. */
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

  explicit ScaleBank(const Scales& scales);

  /// Reads the lower triangles of the Gram matrices only.
  void regress(const Grams& grams, const Eigen::VectorXd& y, const Eigen::VectorXd& noise);

  /// What one scale expects to be added to a mean.
  struct Predicted {
    double weight;
    Vector mean;
    Block covariance;
    double noise;  ///< [1] factor on the noise of what is measured
  };
  /// Of each scale that weighs at least `least`; `cross` to what was measured, `own` of the mean.
  std::vector<Predicted> predict(const Cross& cross, const Blocks& own, double least) const;

  /// Variance of what was added to each measured mean, known with the noise that was given.
  /** Scales that weigh less than `least` do not count. */
  Eigen::VectorXd doubt(const Eigen::VectorXd& noise, double least) const;

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
  double weight(size_t scale) const { return weights_[static_cast<Eigen::Index>(scale)]; }
  const Scales& scales() const { return scales_; }

 private:
  static constexpr Eigen::Index kLanes = 8;
  using Lanes = Eigen::Array<double, kLanes, 1>;
  /// Eight scales.
  struct Chunk {
    std::array<Lanes, kKinds> variance;
    Lanes noise;
    std::vector<Lanes> factor;  ///< of K + N = L L': rows of L, the diagonal inverted
    std::vector<Lanes> alpha;   ///< (K + N)^-1 y
  };
  void decompose(Chunk& chunk, const Grams& grams, const Eigen::VectorXd& noise) const;
  /// Sets alpha; returns the logarithm of N(y; 0, K + N) without its constant.
  Lanes solve(Chunk& chunk, const Eigen::VectorXd& y) const;
  bool counts(size_t chunk, double least) const;

  Scales scales_;
  Eigen::ArrayXd weights_;
  std::vector<Chunk> chunks_;
  Eigen::Index measured_ = 0;  ///< numbers that were measured
  std::array<Eigen::VectorXd, kKinds> mean_alpha_;
};

/// Gain, what turns do, residuals, lag and entry of the velocity.
using VelocityBank = ScaleBank<2, 5>;
/// Gain, bias, residuals, lag and entry of the turn rate.
using YawBank = ScaleBank<1, 5>;

}  // namespace tread::learner
