// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include <Eigen/Core>

#include "common/pattern/pattern.hpp"
#include "modules/learner/core/rules/rule_config.hpp"
#include "modules/learner/core/rules/twist_profile.hpp"

namespace tread::learner {

/// What is known before anything is measured: patterns as body twists, what one change of ground
/// may do to them, and how exact one execution is. Immutable; filters share it.
/** State x = (f, g, kappa, tau, eta, b, c, then r_x, r_y, r_w of each pattern); see
 * TwistCorrection. D = 7 + 3 n. Residuals of different patterns are correlated by 0.1 k(i, j) + 0.7
 * e(i, j) + 0.2 [i = j],   k = exp(-d(i, j)^2 / 2), d the distance of the patterns' mean (v, w)
 * over 0.6 of the largest |v|, |w| in the set; e the same kernel made even (r_x, r_w) or odd (r_y)
 * under mirroring w -> -w and brought to a unit diagonal: mirrored patterns are correlated by 0.7,
 * neighbours by 0.8. */
class GroundModel {
 public:
  GroundModel(const FilterConfig& config, const PatternSet& shipped);

  size_t patterns() const { return profiles_.size(); }
  Eigen::Index dimension() const { return dimension_; }
  double period() const { return period_; }
  const TwistProfile& profile(size_t pattern) const { return profiles_[pattern]; }

  /// The ten corrections of a pattern out of a state.
  Correction10 correctionOf(const Eigen::VectorXd& x, size_t pattern) const;
  /// Their covariance out of the state's.
  Eigen::Matrix<double, 10, 10> covarianceOf(const Eigen::MatrixXd& P, size_t pattern) const;
  /// Predicted mean twist under a state: shipped mean + H x.
  Eigen::Vector3d meanTwistUnder(const Eigen::VectorXd& x, size_t pattern) const;
  /// P H' (D x 3), for the pattern's H.
  void timesResponse(const Eigen::MatrixXd& P, size_t pattern,
                     Eigen::Matrix<double, Eigen::Dynamic, 3>& result) const;
  /// H A (3 x 3) of a D x 3 matrix.
  Eigen::Matrix3d response(const Eigen::Matrix<double, Eigen::Dynamic, 3>& A, size_t pattern) const;

  /// Q: covariance of what one change of ground does.
  const Eigen::MatrixXd& changeCovariance() const { return change_; }
  /// Q^-1.
  const Eigen::MatrixXd& changeInformation() const { return change_information_; }
  /// Q H' of a pattern.
  const Eigen::Matrix<double, Eigen::Dynamic, 3>& changeResponse(size_t pattern) const {
    return change_response_[pattern];
  }
  /// R: covariance of one execution's mean twist on unchanged ground.
  /** Where the shipped set knows the spread of a pattern's end, half of it and half of what the
   * configuration expects: other grounds may be rougher or smoother than the shipped one. */
  const Eigen::Matrix3d& noise(size_t pattern) const { return noise_[pattern]; }
  /// The same of its end pose (x, y, yaw).
  const Eigen::Matrix3d& endNoise(size_t pattern) const { return end_noise_[pattern]; }
  /// Position in the state of a pattern's own residuals.
  static Eigen::Index ownAt(size_t pattern) {
    return TwistCorrection::kCommon + 3 * static_cast<Eigen::Index>(pattern);
  }

 private:
  void fillChangeCovariance(const FilterConfig& config);
  void fillNoise(const FilterConfig& config, const PatternSet& shipped);

  double period_;
  Eigen::Index dimension_;
  std::vector<TwistProfile> profiles_;
  Eigen::MatrixXd change_;
  Eigen::MatrixXd change_information_;
  std::vector<Eigen::Matrix<double, Eigen::Dynamic, 3>> change_response_;
  std::vector<Eigen::Matrix3d> noise_;
  std::vector<Eigen::Matrix3d> end_noise_;
};

/// R with factors q on its variances: sqrt(q_i q_j) R_ij.
Eigen::Matrix3d scaledNoise(const Eigen::Matrix3d& R, const Eigen::Vector3d& factors);

}  // namespace tread::learner
