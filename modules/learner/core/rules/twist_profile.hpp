// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <vector>

#include <Eigen/Core>

#include "common/pattern/pattern.hpp"
#include "modules/learner/core/scaling.hpp"

namespace tread::learner {

/// What ground may do to the body twist of a pattern: corrections relative to the shipped
/// prediction.
/** With v, s, w the shipped forward, lateral and yaw velocity of a sample [m/s, m/s, rad/s]:
 *    forward   v' = v (1 + f + r_x - tau |w|)
 *    lateral   s' = s + kappa |v| w + (c + r_y) v
 *    yaw       w' = w (1 + g + r_w + eta |v|) + b v
 * f forward gain [1], g yaw gain [1], kappa sideslip [s], tau turn loss [s], eta yaw gain by speed
 * [s/m], b yaw bias [rad/m], c crab [1] are common to all patterns; r_x, r_y, r_w [1] are the
 * pattern's own. Linear in the ten, so that a mean twist is corrected exactly by a matrix; only
 * predictions are kept within what ground can do (factors 0..3, lateral +-|v|, bias +-0.5 rad/m).
 */
struct TwistCorrection {
  enum Index { kForward, kYaw, kSideslip, kTurnLoss, kYawBySpeed, kYawBias, kCrab, kCommon };
  static constexpr int kOwn = 3;               ///< r_x, r_y, r_w, after the common ones
  static constexpr int kAll = kCommon + kOwn;  ///< ten
};
using Correction10 = Eigen::Matrix<double, TwistCorrection::kAll, 1>;

/// The body twists of a pattern's shipped prediction, sample by sample.
/** A sample's twist is the constant one that leads from a pose to the next (SE(2) logarithm).
 * Corrected profiles are integrated again exactly: in a sample of dt the pose moves by the chord
 *    dt sinc(w' dt / 2) (v', s'),   turned by the yaw in the middle of the sample. */
class TwistProfile {
 public:
  TwistProfile(const MotionPattern& shipped, double period);

  /// R under a correction. Allocates nothing.
  void integrate(const Correction10& correction, Trajectory prediction) const;
  /// Its last pose alone.
  Pose2 integrateEnd(const Correction10& correction) const;

  /// Mean shipped twist (v, s, w).
  const Eigen::Vector3d& mean() const { return mean_; }
  /// Change of the mean twist per unit of each correction.
  const Eigen::Matrix<double, 3, TwistCorrection::kAll>& meanResponse() const {
    return mean_response_;
  }
  /// Change of the last pose (x, y, yaw) per unit of each correction, at the shipped prediction.
  const Eigen::Matrix<double, 3, TwistCorrection::kAll>& endResponse() const {
    return end_response_;
  }
  /// Change of the last pose per unit of a constant twist (v, s, w) added to all samples [s, m s].
  const Eigen::Matrix3d& endLever() const { return end_lever_; }
  double duration() const { return period_ * static_cast<double>(forward_.size()); }
  /// Mean |v| and |w| along the pattern: how large it is, also where it goes there and back.
  double meanSpeed() const { return mean_speed_; }
  double meanTurn() const { return mean_turn_; }

 private:
  template <typename Put>
  Pose2 walk(const Correction10& correction, Put&& put) const;
  void measureResponses();

  double period_;
  std::vector<double> forward_, lateral_, yaw_;  ///< [m/s, m/s, rad/s] by sample
  Eigen::Vector3d mean_;
  Eigen::Matrix<double, 3, TwistCorrection::kAll> mean_response_;
  Eigen::Matrix<double, 3, TwistCorrection::kAll> end_response_;
  Eigen::Matrix3d end_lever_;
  double mean_speed_ = 0.0;
  double mean_turn_ = 0.0;
};

/// Mean body twist of a trajectory that begins in (0, 0, 0); allocates nothing.
Eigen::Vector3d meanTwist(const ConstTrajectory& trajectory, double period);

}  // namespace tread::learner
