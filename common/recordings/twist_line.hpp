// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <string>
#include <vector>

#include <Eigen/Core>

#include "common/geometry/se2.hpp"
#include "common/geometry/track.hpp"

namespace tread::recordings {

/// Standard deviation of a normal distribution relative to its median absolute deviation.
inline constexpr double kMadToSigma = 1.4826;

/// How a robust fit groups and scales its rows.
struct HuberLimits {
  int group = 1;             ///< number of neighbouring rows of one observation
  double least_scale = 0.0;  ///< [unit of b] lower limit of the residual scale
};

/// x that minimises the sum of rho(|A x - b| per observation), rho of Huber (k = 1.345 scales).
/** Solved by iteratively reweighted least squares (QR); the scale is kMadToSigma times the
 * median residual length per row, at least `least_scale`. `prior` holds a weight for each
 * observation; zero excludes it. Deterministic. */
Eigen::VectorXd huberFit(const Eigen::MatrixXd& A, const Eigen::VectorXd& b,
                         const Eigen::VectorXd& prior, const HuberLimits& limits);

/// Mean and change of the body twist over a window.
struct TwistLine {
  Twist2 mean;   ///< [m/s, m/s, rad/s] at the middle of the window
  Twist2 slope;  ///< per second

  /// v_x, v_y, omega, and their slopes.
  Eigen::Matrix<double, 6, 1> vector() const;
  static TwistLine of(const Eigen::Matrix<double, 6, 1>& vector);
  /// The twist `time` seconds after the beginning of a window of `duration`.
  Twist2 at(double time, double duration) const;
  /// The motion of the mirrored robot.
  TwistLine mirrored() const;
};

/// Why a window cannot be smoothed, in words (a gap of more than 0.4 s, fewer than 5 poses); empty
/// if it can.
std::string windowProblem(const std::vector<PoseSample>& poses, double duration);

/// The profile that fits the poses of a window best. windowProblem() must be empty.
TwistLine smoothed(const std::vector<PoseSample>& poses, double duration);

/// Poses after each of `samples` periods, relative to the start: the profile integrated.
std::vector<Pose2> integrated(const TwistLine& profile, size_t samples, double period);

}  // namespace tread::recordings
