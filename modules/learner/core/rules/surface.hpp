// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cmath>
#include <cstdint>
#include <limits>
#include <memory>
#include <vector>

#include <Eigen/Core>

#include "modules/learner/core/rules/ground_model.hpp"
#include "modules/learner/core/rules/scale_bank.hpp"

namespace tread::learner {

/// Upper limit of a count of executions; a double represents all integers up to it.
inline constexpr double kMostExecutions = 9e15;

/// Whether a number from a file is an integer in [0, most]: only then it may be converted.
inline bool isCount(double number, double most) {
  return number >= 0.0 && number <= most && number == std::floor(number);
}

/// Smaller weights are ignored in moments [1].
inline constexpr double kLeastInMoments = 1e-3;
/// Limits of noise below and above its expectation: factors on variances [1].
inline constexpr double kLeastNoise = 0.05;
inline constexpr double kMostNoise = 50.0;

/// The mean twist of one execution, or of its beginning.
struct TwistSample {
  PatternPart part;
  Eigen::Vector3d mean_twist;  ///< measured, body frame [m/s, m/s, rad/s]
  /// v_body before it minus the steady one of the part's entry class, as shipped; NaN: not
  /// measured.
  Eigen::Vector3d entry = Eigen::Vector3d::Constant(std::numeric_limits<double>::quiet_NaN());

  /// z - m, in the frame of the path.
  Eigen::Vector3d deviation() const {
    Eigen::Vector3d d = mean_twist - part.mean;
    d.head<2>() = part.to_path * d.head<2>();
    return d;
  }
};

/// Corrections of all patterns of a set.
struct SetCorrection {
  Eigen::Matrix<double, TwistCorrection::kCommon, 1> common;
  Eigen::Matrix<double, TwistCorrection::kOwn, Eigen::Dynamic> own;  ///< a column for each pattern

  static SetCorrection none(size_t patterns);
  TwistCorrection of(size_t pattern) const {
    return {common, own.col(static_cast<Eigen::Index>(pattern))};
  }
  Eigen::Vector3d added(const PatternPart& part) const { return of(part.pattern).added(part); }
};

/// Expectation of a surface before any measurement on it: corrections about a centre, with a
/// mixture of scales for their distance; and the scatter of executions.
struct SurfacePrior {
  SetCorrection centre;
  VelocityBank::Scales velocity;
  YawBank::Scales yaw;
  /// Variances along, across and of yaw, divided by the model's, a column for each pattern [1].
  Eigen::Matrix3Xd scatter;
};

/// Mean and covariance of a mean twist, in the frame of its path.
struct Moments {
  Eigen::Vector3d mean;
  Eigen::Matrix3d covariance;
};

/// One surface: all measurements on it and their consequences.
/** Measurements: for each pattern (or beginning of one) the number n, sum and sum of squares of the
 * deviations z - m of its mean twist from the shipped one, along and across its path and in yaw.
 * The means feed two banks of regressions (scale_bank.hpp), of velocity and of yaw; the noise of a
 * mean is q R / n, R the model's noise times this pattern's expected factor, q the surface's own
 * factor for each axis:
 *    q = b / a,   a = a0 + sum n / 2,   b = a0 + sum E[(z - m - h' x)^2] / (2 R)
 * with a0 half the weight of the expected noise in executions; the regression uses q of the
 * previous step (one step of expectation-maximisation per execution).
 * An entry deviation persists for a while: with d the twist before an execution minus the usual
 * one on this surface before patterns of its class, the mean twist changes by
 *    (tau + x) d sigma,   sigma = (1 - exp(-T / 0.5 s)) / T
 * with tau = 0.05 s, which every vehicle needs to settle, and x for velocity and for turn a part
 * of the two regressions: it is estimated from the differences between patterns in their mean d.
 * Within a pattern d is mostly INS noise, which would flatten a slope over it. Predictions are for
 * the usual entry; the regions include the variation of entries. The next execution is expected
 * from a mixture over the scales of Student's t with 2 a degrees of freedom. */
class Surface {
 public:
  Surface(std::shared_ptr<const GroundModel> model, const GroundConfig& config,
          SurfacePrior expectation);

  /// Learns from an execution. The oldest ones fade beyond config.longest_memory executions.
  void add(const GroundConfig& config, const TwistSample& sample);
  /// Changes the expected scatter of executions.
  void expect(const GroundConfig& config, const Eigen::Matrix3Xd& scatter);
  /// Logarithm of the density of an execution; `returned`: additional variance of each axis.
  double logDensity(const TwistSample& sample, const Eigen::Vector3d& returned) const;
  /// The sample as if its entry had been usual; the share of x remains as a response of the part.
  TwistSample asUsual(const TwistSample& sample) const;
  /// Of the mean twist's correction; single executions scatter about it by executionNoise().
  /** Ignores scales that weigh less than `least`. */
  Moments expected(const PatternPart& part, double least = kLeastInMoments) const;
  /// Typical variance of one execution's mean twist, without tails.
  Eigen::Vector3d usualNoise(const PatternPart& part) const;
  /// Variance of one execution's mean twist, along, across and of yaw, over all entries.
  Eigen::Vector3d executionNoise(const PatternPart& part) const;
  /// E[(z - m - h' x)^2] of an execution, divided by the model's noise.
  Eigen::Vector3d squaredError(const TwistSample& sample) const;

  const SetCorrection& correction() const { return correction_; }
  const Eigen::Vector3d& noise() const { return noise_; }
  double executions() const { return executions_; }
  const SurfacePrior& expectation() const { return expectation_; }
  const VelocityBank& velocity() const { return posterior_->velocity; }
  const YawBank& yaw() const { return posterior_->yaw; }

  /// Finite numbers; restore() returns false if they are invalid.
  void save(std::vector<double>& memory) const;
  bool restore(const GroundConfig& config, const std::vector<double>& memory, size_t& at);

 private:
  /// Executions of a pattern, or of one beginning of it; those with a known entry are counted
  /// separately.
  struct Measured {
    PatternPart part;
    bool entered = false;
    double count = 0.0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();
    Eigen::Vector3d squares = Eigen::Vector3d::Zero();
    // Of the entries, in the frame of the path: sums, squares, products with deviations.
    Eigen::Vector3d entries = Eigen::Vector3d::Zero();
    Eigen::Vector3d entry_squares = Eigen::Vector3d::Zero();
    Eigen::Vector3d products = Eigen::Vector3d::Zero();
  };
  /// The usual entry twist before the patterns of a class.
  struct Entries {
    Eigen::Vector3d mean = Eigen::Vector3d::Zero();      ///< as TwistSample::entry
    Eigen::Vector3d variance = Eigen::Vector3d::Zero();  ///< about that
  };
  struct Posterior {
    VelocityBank velocity;
    YawBank yaw;
  };
  Measured& measuredOf(const PatternPart& part, bool entered);
  double R(const PatternPart& part, Eigen::Index axis) const {
    return part.noise[axis] * expectation_.scatter(axis, static_cast<Eigen::Index>(part.pattern));
  }
  void follow(const GroundConfig& config);
  void followEntries();
  void regress();
  void correct();
  Eigen::Vector3d growthByEntries(const Measured& measured, const Eigen::Vector3d& moved) const;
  Eigen::Vector3d squaresWithin(const Measured& measured) const;
  void estimateNoise(const GroundConfig& config);
  VelocityBank::Cross velocityCross(const PatternPart& part) const;
  YawBank::Cross yawCross(const PatternPart& part) const;
  bool restoreMeasured(const std::vector<double>& memory, size_t& at);

  std::shared_ptr<const GroundModel> model_;
  SurfacePrior expectation_;
  std::vector<Measured> measured_;
  double executions_ = 0.0;
  std::vector<Entries> entries_;                ///< by class
  std::shared_ptr<const Posterior> posterior_;  ///< immutable, so that copies share it
  Eigen::Matrix2Xd velocity_noise_;             ///< q R / n, by measured part
  Eigen::VectorXd yaw_noise_;
  SetCorrection correction_;
  Eigen::Vector3d lasts_;                                     ///< [s] x, for each axis
  Eigen::Vector3d expected_noise_ = Eigen::Vector3d::Ones();  ///< q before the last execution
  Eigen::Vector3d noise_ = Eigen::Vector3d::Ones();           ///< q
  Eigen::Vector3d certainty_;                                 ///< a
};

/// Clamps a mean twist to 100 m/s and 100 rad/s, beyond any vehicle.
Eigen::Vector3d plausible(const Eigen::Vector3d& twist);

}  // namespace tread::learner
