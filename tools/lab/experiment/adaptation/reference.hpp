// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "tools/lab/experiment/adaptation/driving.hpp"

// Prediction of a shipped set for any command series: the body twist per sample.
//   1. Commands become the body motion (v, w) of an ideal differential drive, with a dead time and
//   a
//      first-order lag.
//   2. Each velocity of the twist is linear in terms of that motion:
//      v_x: v, |w| v, w, |v| v      v_y: v w, v, w      omega: w, |v| w, v, |w| w.
//   3. Coefficients are fitted to the mean twists of the training pieces (Huber loss, weighted by
//      noise); the lags are those with the smallest error.
// All rules start with this model and correct it.
namespace tread::adaptation {

inline constexpr size_t kAxes = 3;  ///< v_x, v_y, omega

/// Dead time and time constant [s].
struct Lag {
  double delay = 0.0;
  double time_constant = 0.0;
};

/// (v, w) of a segment's commands after a lag, mean of each sample [m/s, rad/s].
std::vector<Eigen::Vector2d> lagged(const SampledSegment& segment, double baseline, const Lag& lag);

/// Variance of a piece's mean twist on unchanged ground: a + b v^2 + c w^2 of the mean |v| and |w|,
/// for each velocity. The defaults apply if too few pieces were recorded.
struct NoiseModel {
  std::array<Eigen::Vector3d, kAxes> factors{Eigen::Vector3d{0.0025, 0.0025, 0.0025},
                                             Eigen::Vector3d{0.0025, 0.0025, 0.0025},
                                             Eigen::Vector3d{0.0025, 0.0025, 0.01}};

  Eigen::Vector3d of(const Eigen::Vector2d& speed) const;
};

/// Residual of a piece relative to the reference.
struct Sample {
  /// mean v_x and omega of each part, from the reference
  std::array<Eigen::Vector2d, kParts> speeds;
  Eigen::Vector3d twist;     ///< mean twist, from the reference
  Eigen::Vector3d residual;  ///< measured mean twist minus that of the reference
  Eigen::Vector3d noise;     ///< its variance
  bool repeats = false;      ///< under the same steady command as the previous sample

  /// Mean |v| and |w|.
  Eigen::Vector2d meanSpeed() const;
};

/// Means of the terms over each piece, for each lag: the data of a reference fit.
class TermTable {
 public:
  explicit TermTable(const SampledSession& session);

  static const std::vector<Lag>& lags();
  static constexpr Eigen::Index kTerms = 7;  ///< v, w, |w| v, |v| w, |v| v, |w| w, v w
  static Eigen::Matrix<double, 1, kTerms> terms(const Eigen::Vector2d& motion);
  /// pieces x kTerms
  const Eigen::MatrixXd& of(size_t lag) const { return means_[lag]; }
  /// pieces x 3
  const Eigen::MatrixXd& twists() const { return twists_; }

 private:
  std::vector<Eigen::MatrixXd> means_;
  Eigen::MatrixXd twists_;
};

/// The model that all rules start with.
class Reference {
 public:
  /// Fits lags and coefficients to the pieces of some sessions; at least ten pieces are needed.
  explicit Reference(const std::vector<const TermTable*>& training);
  /// Fits only the coefficients, with the lags of another reference.
  Reference(const std::vector<const TermTable*>& training, const Reference& lags);

  /// Twists of all samples of a segment.
  std::vector<Twist2> twists(const SampledSegment& segment, double baseline) const;
  const Lag& lag(size_t axis) const { return TermTable::lags()[lag_[axis]]; }

 private:
  void fit(const std::vector<const TermTable*>& training, size_t axis, size_t lag, double& error,
           Eigen::VectorXd& coefficients) const;

  std::array<size_t, kAxes> lag_{};
  std::array<Eigen::VectorXd, kAxes> coefficients_;
};

/// A reference's twists for a whole session, by piece.
struct Predicted {
  std::vector<std::vector<Twist2>> twists;  ///< by piece and sample
  std::vector<Sample> samples;              ///< by piece; their noise is still unset
};
Predicted predicted(const SampledSession& session, const Reference& reference);

/// Poses after each sample of twists that are held for `period` [s].
std::vector<Pose2> integrated(const std::vector<Twist2>& twists, double period = kPeriod);

/// Prediction for a series of samples, without measurement.
Sample sampleOf(const std::vector<Twist2>& twists);

/// Scatter of executions on unchanged ground: half the squared difference of consecutive pieces
/// under one steady command.
NoiseModel noiseOf(const std::vector<std::vector<Sample>>& sessions);

}  // namespace tread::adaptation
