// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <vector>

#include <Eigen/Core>

#include "common/pattern/pattern.hpp"
#include "modules/learner/core/rules/learning_rule.hpp"
#include "modules/learner/core/rules/scale_bank.hpp"
#include "modules/learner/core/scaling.hpp"

namespace tread::learner {

inline double squared(double value) {
  return value * value;
}

/// The velocities of a body twist: forward, lateral, yaw.
inline constexpr size_t kVelocities = 3;

/// Scale of the corrections, to make them dimensionless: the largest mean speed and turn rate of
/// the set, and half the gauge.
struct BodyScale {
  double speed = 1.0;              ///< [m/s] v_ref
  double turn = 1.0;               ///< [rad/s] w_ref, at least .2 v_ref / lever
  double lever = 0.3;              ///< [m]
  Eigen::Vector2d axis{1.0, 0.0};  ///< main direction of the set's motion
  double lag_as_turn = 0.0;        ///< [1/s] yaw gain that imitates a lag of turns in this set
  double isotropy = 0.0;  ///< [1] 0: motion along one axis only; 1: equally in all directions
};

struct PatternPart;

/// Change of a pattern's body twist by the ground, relative to the shipped prediction.
/** With V the shipped velocity (forward, lateral) [m/s] and w the turn rate [rad/s] of a sample, J
 * the rotation by 90 degrees, B = [[b1, b2], [b2, -b1]]:
 *    V' = V (1 + a - tau |w|/w_ref) + J V (c + kappa w/w_ref) + B V + (v_ref/w_ref) w e + o A r
 *    w' = w (1 + g + eta |V|/v_ref + r_g) + b . V + |V| r_b + l_w u
 * with V(t - l) for V: on this ground the vehicle responds later than in the set, by a lag l [s],
 * in turns by l_w [s]; u [rad/s2] is the mean loss of the pattern's turn rate per second of that
 * lag, minus the part that looks like a yaw gain over the set. Common to all patterns are a gain,
 * c crab, b1 and b2 shear, tau turn loss, kappa sideslip, e shift of the centre of rotation, g yaw
 * gain, eta yaw gain by speed, all [1], and b yaw bias [rad/m]; r [1], along and across the set's
 * axis A, r_g [1] and r_b [rad/m] are the pattern's own; o = hypot(|V|, v_ref |w| / (2 w_ref)). No
 * term depends on the choice of the forward direction: in a rotated frame everything rotates.
 * Predictions are limited to what ground can cause. */
struct TwistCorrection {
  enum Common {
    kGain,
    kCrab,
    kShear,
    kShearAcross,
    kTurnLoss,
    kSideslip,
    kShiftX,
    kShiftY,
    kLag,
    kYaw,
    kYawBySpeed,
    kBiasX,
    kBiasY,
    kYawLag,
    kCommon
  };
  static constexpr int kVelocity = 9;  ///< that act on V; the others act on w
  static constexpr int kTurning = kCommon - kVelocity;
  enum Own { kAlong, kAcross, kYawOwn, kBiasOwn, kOwn };

  Eigen::Matrix<double, kCommon, 1> common = Eigen::Matrix<double, kCommon, 1>::Zero();
  Eigen::Matrix<double, kOwn, 1> own = Eigen::Matrix<double, kOwn, 1>::Zero();

  /// Change of a part's mean twist, in the frame of its path.
  Eigen::Vector3d added(const PatternPart& part) const;
};

/// A part of a pattern, usually its beginning or the whole of it, covered by one measurement.
/** Twists are in the frame of its path: along the shipped mean velocity, across it, yaw. */
struct PatternPart {
  size_t pattern = 0;
  Eigen::Index first = 0;  ///< its first sample
  Eigen::Index samples = 0;
  Eigen::Vector3d mean;               ///< shipped mean twist, body frame [m/s, m/s, rad/s]
  Eigen::Matrix2d to_path;            ///< rotates a body vector into the frame of the path
  Eigen::Vector3d noise;              ///< variance of one execution's mean twist
  double metres = 0.0;                ///< driven, as shipped
  double speed = 0.0, turning = 0.0;  ///< mean |V| [m/s], mean |w| [rad/s]
  double shape = 0.0;                 ///< [m2] variance of x and y of its end in addition to that
  size_t entry_class = 0;
  /// [1/s] share with which a deviation of the entry twist persists: see Surface
  double settling = 0.0;
  /// That share of the entry twist's deviation from the usual one, in the same frame.
  Eigen::Vector3d entry = Eigen::Vector3d::Zero();
  /// Derivative of the mean velocity with respect to its corrections and the pattern's own.
  Eigen::Matrix<double, 2, TwistCorrection::kVelocity> velocity;
  Eigen::Matrix2d own;
  Eigen::Matrix<double, 1, TwistCorrection::kTurning> yaw;  ///< the same of the mean turn rate
  double yaw_own = 0.0, bias_own = 0.0;

  /// Rotates a twist from the frame of the path into the body frame.
  Eigen::Matrix3d toBody() const {
    Eigen::Matrix3d turn = Eigen::Matrix3d::Identity();
    turn.topLeftCorner<2, 2>() = to_path.transpose();
    return turn;
  }
};

/// The body twists of a pattern's shipped prediction, sample by sample.
/** A sample's twist is the constant one that leads from a pose to the next (SE(2) logarithm).
 * Corrected profiles are integrated exactly: in a sample of dt the pose moves by the chord
 *    dt sinc(w' dt / 2) V',   rotated by the yaw in the middle of the sample. */
class TwistProfile {
 public:
  TwistProfile(const MotionPattern& shipped, double period);

  /// R with a correction. Allocates nothing.
  void integrate(const BodyScale& scale, const TwistCorrection& correction,
                 Trajectory prediction) const;
  /// Only its last pose.
  Pose2 integrateEnd(const BodyScale& scale, const TwistCorrection& correction) const;
  /// Mean twist of this many samples from `first` on, and its derivatives; without noise.
  PatternPart part(const BodyScale& scale, Eigen::Index first, Eigen::Index samples) const;
  /// Derivative of the last pose with respect to a constant twist added to all samples [s, m s].
  const Eigen::Matrix3d& endLever() const { return end_lever_; }
  Eigen::Index samples() const { return static_cast<Eigen::Index>(twists_.size()); }
  const std::vector<Eigen::Vector3d>& twists() const { return twists_; }

 private:
  Eigen::Vector2d velocityBefore(double samples, size_t t) const;
  template <typename Put>
  Pose2 walk(const BodyScale& scale, const TwistCorrection& correction, Put&& put) const;

  double lossByLag(const BodyScale& scale, Eigen::Index first, Eigen::Index samples) const;

  double period_;
  std::vector<Eigen::Vector3d> twists_;  ///< [m/s, m/s, rad/s]
  Eigen::Matrix3d end_lever_;
};

/// Mean body twist of this many samples, from `first` on, of a trajectory that begins in (0, 0, 0);
/// allocates nothing.
Eigen::Vector3d meanTwist(const ConstTrajectory& trajectory, Eigen::Index first,
                          Eigen::Index samples, double period);

/// Patterns as body twists, their similarity, and the accuracy of one execution. Immutable.
class GroundModel {
 public:
  GroundModel(const GroundConfig& config, const PatternSet& shipped);

  size_t patterns() const { return profiles_.size(); }
  double period() const { return period_; }
  const BodyScale& scale() const { return scale_; }
  const TwistProfile& profile(size_t pattern) const { return profiles_[pattern]; }
  PatternPart part(size_t pattern, Eigen::Index first, Eigen::Index samples) const;
  const PatternPart& whole(size_t pattern) const { return whole_[pattern]; }

  size_t classes() const { return class_twists_.size(); }
  /// A body twist before a pattern minus the steady one of its entry class, as shipped.
  Eigen::Vector3d besideClass(size_t pattern, const Twist2& entry) const;

  /// Correlation of the patterns' own corrections: along the set's axis, across it, of yaw gain and
  /// of yaw bias.
  /** .1 k + .7 m + .2 [i = j] for a set that moves along one axis: k = exp(-d^2 / 2), d the
   * distance of the mean twists over .6 of v_ref and w_ref, m the same kernel made even or odd
   * under mirroring at the axis (V_across, w) -> -(V_across, w), with a unit diagonal; blended
   * towards .6 k + .4 [i = j] as the set moves in all directions, where patterns are no mirror
   * images. */
  const Eigen::MatrixXd& alike(TwistCorrection::Own own) const { return alike_[own]; }

  // Covariances of the ground's changes to the mean twists of two parts, for a ground of scale 1
  // without residuals, and per unit of residuals; spreads of the corrections: see ground_model.cpp.
  VelocityBank::Blocks velocity(const PatternPart& a, const PatternPart& b) const;
  YawBank::Blocks yaw(const PatternPart& a, const PatternPart& b) const;

  /// Share of the yaw bias's variance that differs between patterns [1].
  double biasApart() const;
  /// Variances of the common corrections on a ground of scale 1 (gain, turns, yaw gain, lags), and
  /// of yaw bias 1 rad/m.
  const Eigen::Matrix<double, TwistCorrection::kCommon, 1>& spread() const { return spread_; }
  /// Standard deviation of how long an entry deviation persists [s].
  static constexpr double kEntrySpread = 0.15;

 private:
  void measureScale(double lever);
  void fillAlike();

  double period_;
  TwistNoise noise_;
  BodyScale scale_;
  std::vector<TwistProfile> profiles_;
  std::vector<Eigen::Vector3d> class_twists_;
  std::vector<size_t> entry_classes_;  ///< by pattern
  std::vector<double> recorded_share_;
  std::vector<Eigen::Matrix3d> recorded_;  ///< covariance of the mean twist, body frame
  std::vector<PatternPart> whole_;
  std::array<Eigen::MatrixXd, TwistCorrection::kOwn> alike_;
  Eigen::Matrix<double, TwistCorrection::kCommon, 1> spread_;
};

}  // namespace tread::learner
