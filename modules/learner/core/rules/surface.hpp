// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <vector>

#include <Eigen/Core>

#include "modules/learner/core/rules/ground_model.hpp"

namespace tread::learner {

/// A number for each of forward, lateral and yaw velocity.
template <class T>
using ByVelocity = std::array<T, kVelocities>;

/// No count of executions is beyond this; a double holds all whole numbers up to it.
inline constexpr double kMostExecutions = 9e15;

/// Whether a number from a file is a whole one in [0, most]: only then it may become an integer.
inline bool isCount(double number, double most) {
  return number >= 0.0 && number <= most && number == std::floor(number);
}

/// Nothing is that much calmer or rougher than expected: factors on variances [1].
inline constexpr double kLeastNoise = 0.05;
inline constexpr double kMostNoise = 50.0;

/// The mean twist of one execution, or of its beginning.
struct TwistSample {
  PatternPart part;
  Eigen::Vector3d mean_twist;  ///< measured [m/s, m/s, rad/s]
};

/// What is expected of a surface before anything was measured on it: x ~ N(centre, Q), and how
/// executions scatter.
struct SurfacePrior {
  ByVelocity<Eigen::VectorXd> centre;
  Eigen::Matrix3d common;  ///< variances of the common corrections, a column for each velocity
  double residual = 1.0;   ///< [1] covariance of the residuals over the ground model's
  /// Variances of v_x, v_y and omega over the ground model's, a column for each pattern [1].
  Eigen::Matrix3Xd scatter;
};

/// One surface: all that was measured on it, and what follows from that.
/** Measured: for each pattern (or beginning of one) the number n, sum and sum of squares of the
 * deviations z - m of its mean twist from the shipped one. From that, for each velocity on its own,
 * a linear regression z = m + h' x + e, e ~ N(0, q R), R the ground model's noise times what the
 * prior says of this pattern, q the surface's own factor [1]:
 *    P = (1 / Q + sum n h h' / (q R))^-1
 *    x = centre + P sum h sum(z - m - h' centre) / (q R)
 *    q = b / a,   a = a0 + sum n / 2,   b = a0 + sum E[(z - m - h' x)^2] / (2 R)
 * with a0 half the executions that the expected noise counts for; where P is computed q is that of
 * the step before (one step of expectation-maximisation an execution). A next execution is expected
 * from Student's t with 2 a degrees of freedom about m + h' x, scale^2 = h' P h + q R. */
class Surface {
 public:
  Surface(const GroundModel& model, const GroundConfig& config, const SurfacePrior& prior);

  /// Learns from an execution. The oldest fade beyond config.longest_memory executions.
  void add(const GroundModel& model, const GroundConfig& config, const TwistSample& sample);
  /// Executions are expected to scatter otherwise than when it began.
  void expect(const GroundModel& model, const GroundConfig& config,
              const Eigen::Matrix3Xd& scatter);
  /// E[(z - m - h' x)^2] of an execution that it has learned from, over the ground model's noise.
  Eigen::Vector3d squaredError(const TwistSample& sample) const;
  /// Logarithm of the density of an execution on this surface.
  double logDensity(const TwistSample& sample) const;

  const ByVelocity<Eigen::VectorXd>& mean() const { return x_; }
  const ByVelocity<Eigen::MatrixXd>& covariance() const { return P_; }
  /// What it adds to the mean twist of an execution, and the variance of that.
  Eigen::Vector3d added(const PatternPart& part) const;
  Eigen::Vector3d doubt(const PatternPart& part) const;
  /// Variance of the mean twist of one execution: that of the next one, not of its expectation.
  Eigen::Vector3d executionNoise(const PatternPart& part) const;
  /// q: variance of one execution over R, for v_x, v_y and omega.
  const Eigen::Vector3d& noise() const { return noise_; }
  double executions() const { return executions_; }
  const SurfacePrior& prior() const { return prior_; }

  /// Numbers, all of them finite; restore() returns false if they do not fit, and the surface is of
  /// no use then.
  void save(std::vector<double>& memory) const;
  bool restore(const GroundModel& model, const GroundConfig& config,
               const std::vector<double>& memory, size_t& at);

 private:
  /// Executions of one part of a pattern.
  struct Measured {
    PatternPart part;
    double count = 0.0;
    Eigen::Vector3d sum = Eigen::Vector3d::Zero();      ///< of z - m
    Eigen::Vector3d squares = Eigen::Vector3d::Zero();  ///< of (z - m)^2
  };
  Measured& measuredOf(const PatternPart& part);
  double R(const PatternPart& part, Eigen::Index velocity) const {
    return part.noise[velocity] * prior_.scatter(velocity, static_cast<Eigen::Index>(part.pattern));
  }
  void follow(const GroundModel& model, const GroundConfig& config);
  Eigen::MatrixXd priorCovariance(const GroundModel& model, size_t velocity) const;
  void regress(const GroundModel& model);
  void estimateNoise(const GroundConfig& config);
  bool restoreMeasured(const GroundModel& model, const std::vector<double>& memory, size_t& at);

  SurfacePrior prior_;
  std::vector<Measured> measured_;
  double executions_ = 0.0;
  ByVelocity<Eigen::VectorXd> x_;
  ByVelocity<Eigen::MatrixXd> P_;
  Eigen::Vector3d expected_noise_ = Eigen::Vector3d::Ones();  ///< q before the last execution
  Eigen::Vector3d noise_ = Eigen::Vector3d::Ones();           ///< q
  Eigen::Vector3d certainty_;                                 ///< a
};

/// No vehicle's mean twist is beyond 100 m/s, 100 rad/s, whatever was measured.
Eigen::Vector3d plausible(const Eigen::Vector3d& twist);

}  // namespace tread::learner
