// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "common/pattern/pattern.hpp"
#include "modules/learner/core/rules/learning_rule.hpp"
#include "modules/learner/core/scaling.hpp"

namespace tread::learner {

/// What ground may do to the body twist of a pattern: corrections relative to the shipped
/// prediction.
/** With v, s, w the shipped forward, lateral and yaw velocity of a sample [m/s, m/s, rad/s]:
 *    forward   v' = v (1 + f + r_x - tau |w|) + e w
 *    lateral   s' = s + kappa |v| w + (c + r_y) v + o w
 *    yaw       w' = w (1 + g + r_w + eta |v|) + b v
 * f forward gain [1], tau turn loss [s], e push [m] (one track holds better than the other), kappa
 * sideslip [s], c crab [1], o shift of the point about which it turns [m], g yaw gain [1], eta yaw
 * gain by speed [s/m], b yaw bias [rad/m] are common to all patterns; r_x, r_y, r_w [1] are the
 * pattern's own. Linear in the twelve, so that a mean twist is corrected exactly by a matrix; only
 * predictions are kept within what ground can do (factors 0..3, lateral +-|v|, bias +-0.5 rad/m,
 * push and shift +-0.5 m). */
struct TwistCorrection {
  enum Index {
    kForward,
    kTurnLoss,
    kPush,
    kSideslip,
    kCrab,
    kShift,
    kYaw,
    kYawBySpeed,
    kYawBias,
    kCommon
  };
  static constexpr int kOwn = 3;               ///< r_x, r_y, r_w, after the common ones
  static constexpr int kAll = kCommon + kOwn;  ///< twelve
};
using CorrectionVector = Eigen::Matrix<double, TwistCorrection::kAll, 1>;
/// The velocities of a body twist: forward, lateral, yaw.
inline constexpr size_t kVelocities = 3;

/// Of each velocity three common corrections, in the order of TwistCorrection: of velocity i those
/// from 3 i on. Its state is those three, then its r of each pattern.
/** No correction acts on two velocities, so that the three are learned apart. */
inline constexpr Eigen::Index kTerms = 3;

/// The beginning of a pattern, or the whole of it, as what one measurement of it tells.
struct PatternPart {
  size_t pattern = 0;
  Eigen::Index samples = 0;
  Eigen::Vector3d mean;   ///< shipped mean twist [m/s, m/s, rad/s]
  Eigen::Vector3d noise;  ///< variance of one execution's mean twist on even ground
  double metres = 0.0;    ///< driven, as shipped
  double shape = 0.0;     ///< [m2] variance of x and of y of its end beyond that of the mean twist
  /// Change of each mean velocity per unit of its common corrections and of the pattern's own.
  std::array<std::array<double, kTerms>, kVelocities> common{};
  std::array<double, kVelocities> own{};
};

/// The body twists of a pattern's shipped prediction, sample by sample.
/** A sample's twist is the constant one that leads from a pose to the next (SE(2) logarithm).
 * Corrected profiles are integrated again exactly: in a sample of dt the pose moves by the chord
 *    dt sinc(w' dt / 2) (v', s'),   turned by the yaw in the middle of the sample. */
class TwistProfile {
 public:
  TwistProfile(const MotionPattern& shipped, double period);

  /// R under a correction. Allocates nothing.
  void integrate(const CorrectionVector& correction, Trajectory prediction) const;
  /// Its last pose alone.
  Pose2 integrateEnd(const CorrectionVector& correction) const;

  /// Mean twist (v, s, w) of the first samples, and its responses; no noise yet.
  PatternPart part(Eigen::Index samples) const;
  /// Change of the last pose (x, y, yaw) per unit of each correction, at the shipped prediction.
  const Eigen::Matrix<double, 3, TwistCorrection::kAll>& endResponse() const {
    return end_response_;
  }
  /// Change of the last pose per unit of a constant twist (v, s, w) added to all samples [s, m s].
  const Eigen::Matrix3d& endLever() const { return end_lever_; }
  Eigen::Index samples() const { return static_cast<Eigen::Index>(forward_.size()); }
  /// Mean |v| and |w| of the first samples: how large they are, also there and back.
  Eigen::Vector2d meanSpeed(Eigen::Index samples) const;
  /// Twist (v, s, w) of the last of the first samples less that of the first one.
  Eigen::Vector3d change(Eigen::Index samples) const;

 private:
  template <typename Put>
  Pose2 walk(const CorrectionVector& correction, Put&& put) const;
  void measureResponses();

  double period_;
  std::vector<double> forward_, lateral_, yaw_;  ///< [m/s, m/s, rad/s] by sample
  Eigen::Matrix<double, 3, TwistCorrection::kAll> end_response_;
  Eigen::Matrix3d end_lever_;
};

/// Mean body twist of the first samples of a trajectory that begins in (0, 0, 0); allocates
/// nothing.
Eigen::Vector3d meanTwist(const ConstTrajectory& trajectory, Eigen::Index samples, double period);

/// What is known before anything is measured: patterns as body twists, how far surfaces lie apart,
/// and how exact one execution is. Immutable; all hypotheses share it.
/** State of a velocity: x = (its common corrections, then its r of each pattern). Residuals of
 * different patterns are correlated by 0.1 k(i, j) + 0.7 e(i, j) + 0.2 [i = j],
 * k = exp(-d(i, j)^2 / 2), d the distance of the patterns' mean (v, w) over 0.6 of the largest |v|,
 * |w| in the set; e the same kernel made even (r_x, r_w) or odd (r_y) under mirroring w -> -w and
 * brought to a unit diagonal: mirrored patterns are correlated by 0.7, neighbours by 0.8. */
class GroundModel {
 public:
  GroundModel(const GroundConfig& config, const PatternSet& shipped);

  size_t patterns() const { return profiles_.size(); }
  double period() const { return period_; }
  const TwistProfile& profile(size_t pattern) const { return profiles_[pattern]; }
  /// Length of each velocity's state.
  Eigen::Index dimension() const { return kTerms + static_cast<Eigen::Index>(profiles_.size()); }
  /// Q: covariance of a velocity's corrections over the surfaces that there are.
  const Eigen::MatrixXd& spread(size_t velocity) const { return spread_[velocity]; }
  /// The first samples of a pattern; `samples` is at least 1 and at most those of the pattern.
  PatternPart part(size_t pattern, Eigen::Index samples) const;
  const PatternPart& whole(size_t pattern) const { return whole_[pattern]; }

 private:
  void fillSpread(const GroundConfig& config);

  double period_;
  TwistNoise noise_;
  std::vector<TwistProfile> profiles_;
  std::vector<double> recorded_share_;     ///< by pattern; 0 where no spread was recorded
  std::vector<Eigen::Vector3d> recorded_;  ///< variance of the mean twist, by pattern
  std::vector<PatternPart> whole_;
  std::array<Eigen::MatrixXd, kVelocities> spread_;
};

/// h' x: what corrections of a velocity do to its mean in a part of a pattern.
template <class Vector>
double response(const PatternPart& part, size_t velocity, const Vector& x) {
  double sum = part.own[velocity] * x[kTerms + static_cast<Eigen::Index>(part.pattern)];
  for (Eigen::Index i = 0; i < kTerms; ++i)
    sum += part.common[velocity][static_cast<size_t>(i)] * x[i];
  return sum;
}

}  // namespace tread::learner
