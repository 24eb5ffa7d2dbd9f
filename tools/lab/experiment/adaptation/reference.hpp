// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "tools/lab/experiment/adaptation/driving.hpp"

// What a shipped set would say of any command series: the body twist, sample by sample.
//   1. Commands as body motion (v, w) of an ideal differential drive, late by a dead time and a
//      first-order lag.
//   2. Each velocity of the twist is linear in terms of that motion:
//      v_x: v, |w| v, w, |v| v      v_y: v w, v, w      omega: w, |v| w, v, |w| w.
//   3. Coefficients fit the mean twists of the training pieces (Huber's loss, each piece over its
//      noise); lags are those of the smallest error.
// All rules begin with this and correct it.
namespace tread::adaptation {

inline constexpr size_t kAxes = 3;  ///< v_x, v_y, omega

/// Dead time and time constant [s].
struct Lag {
  double delay = 0.0;
  double time_constant = 0.0;
};

/// (v, w) of the commands of a segment under a lag, a mean for each sample [m/s, rad/s].
std::vector<Eigen::Vector2d> lagged(const SampledSegment& segment, double baseline, const Lag& lag);

/// Variances of a piece's mean twist on the same ground: a + b v^2 + c w^2 of the mean |v| and |w|,
/// for each velocity. What stands here is expected where too few were recorded.
struct NoiseModel {
  std::array<Eigen::Vector3d, kAxes> factors{Eigen::Vector3d{0.0025, 0.0025, 0.0025},
                                             Eigen::Vector3d{0.0025, 0.0025, 0.0025},
                                             Eigen::Vector3d{0.0025, 0.0025, 0.01}};

  Eigen::Vector3d of(const Eigen::Vector2d& speed) const;
};

/// What a piece tells beside the reference.
struct Sample {
  std::array<Eigen::Vector2d, kParts> speeds;  ///< mean v_x and omega of each part, by reference
  Eigen::Vector3d twist;                       ///< mean twist, by reference
  Eigen::Vector3d residual;                    ///< measured mean twist less that of the reference
  Eigen::Vector3d noise;                       ///< its variance
  bool repeats = false;                        ///< under the steady command of the sample before

  /// Mean |v| and |w|.
  Eigen::Vector2d meanSpeed() const;
};

/// Means of the terms over each piece, for each lag: what a reference is fitted to.
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

/// The model that all rules begin with.
class Reference {
 public:
  /// Fits lags and coefficients to the pieces of some sessions; there must be at least ten.
  explicit Reference(const std::vector<const TermTable*>& training);
  /// Fits the coefficients alone, with the lags of another.
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

/// Twists of a reference on a whole session, by piece.
struct Predicted {
  std::vector<std::vector<Twist2>> twists;  ///< by piece and sample
  std::vector<Sample> samples;              ///< by piece; their noise is not yet known
};
Predicted predicted(const SampledSession& session, const Reference& reference);

/// Poses after each sample of twists that are held for `period` [s].
std::vector<Pose2> integrated(const std::vector<Twist2>& twists, double period = kPeriod);

/// What a reference says of a series of samples; nothing is measured of it yet.
Sample sampleOf(const std::vector<Twist2>& twists);

/// How executions scatter on the same ground: half the squared difference of two pieces one after
/// the other under one steady command.
NoiseModel noiseOf(const std::vector<std::vector<Sample>>& sessions);

}  // namespace tread::adaptation
