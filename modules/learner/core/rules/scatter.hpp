// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstddef>

#include <Eigen/Core>

namespace tread::learner {

/// How far executions of each pattern scatter about what is known of the ground, whatever ground:
/// v_x, v_y and omega of the mean twist, and the end beyond it (a path that is not steady ends
/// elsewhere than one of the same mean twist that is).
struct Scatter {
  static constexpr Eigen::Index kQuantities = 4;
  using Factors = Eigen::Matrix<double, kQuantities, Eigen::Dynamic>;

  explicit Scatter(size_t patterns)
      : sums(Eigen::MatrixXd::Zero(1 + kQuantities, static_cast<Eigen::Index>(patterns))) {}

  /// Squared errors of an execution over the ground model's variances.
  void add(size_t pattern, const Eigen::Vector4d& squared_error, double longest_memory);
  /// Expected factors on the variances, a column for each pattern: its mean, drawn by `prior`
  /// executions towards that of all patterns, which is drawn by as many towards 1.
  /** A rough ground tells nothing of the next: where the velocities of all patterns together
   * scatter more than expected, only how patterns differ counts. The next ground would look like
   * any, were it expected to be as rough; how rough it is itself is its own q. */
  Factors expected(double prior) const;

  Eigen::MatrixXd sums;  ///< a column for each pattern: executions, then their squared errors
};

}  // namespace tread::learner
