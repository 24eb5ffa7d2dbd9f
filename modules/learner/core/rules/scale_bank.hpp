// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

namespace tread::learner {

/// A regression of unknown width: one regression for each of several scales, weighted by its
/// evidence.
/** The measurements are means y of kAxes numbers each, y ~ N(0, sum_b s_b G_b + N), G_b the Gram
 * matrix of the b-th kind of spread, s_b its value in a scale, N the (diagonal) noise. With K the
 * sum for a scale, the weight of a scale is its prior weight times N(y; 0, K + N); predictions are
 * the mixture. Scales are computed eight at a time, one in each lane of an array, because the
 * systems are small and their set-up would dominate. */
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

  /// Reads only the lower triangles of the Gram matrices.
  void regress(const Grams& grams, const Eigen::VectorXd& y, const Eigen::VectorXd& noise);

  /// Expected change of a mean for one scale.
  struct Predicted {
    double weight;
    Vector mean;
    Block covariance;
    double noise;  ///< [1] factor on the noise of a measurement
  };
  /// For each scale that weighs at least `least`; `cross` to the measurements, `own` of the mean.
  std::vector<Predicted> predict(const Cross& cross, const Blocks& own, double least) const;

  /// Posterior variance of the change of each measured mean, given the noise.
  /** Ignores scales that weigh less than `least`. */
  Eigen::VectorXd doubt(const Eigen::VectorXd& noise, double least) const;

  /// sum over the scales of weight, s_b and (K + N)^-1 y: the contribution of a kind of spread is
  /// its cross covariance times that.
  const Eigen::VectorXd& meanAlpha(size_t kind) const { return mean_alpha_[kind]; }
  /// Expected factor on the noise.
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
  Eigen::Index measured_ = 0;  ///< number of measured values
  std::array<Eigen::VectorXd, kKinds> mean_alpha_;
};

/// Gain, turn terms, residuals, lag and entry of the velocity.
using VelocityBank = ScaleBank<2, 5>;
/// Gain, bias, residuals, lag and entry of the turn rate.
using YawBank = ScaleBank<1, 5>;

}  // namespace tread::learner
