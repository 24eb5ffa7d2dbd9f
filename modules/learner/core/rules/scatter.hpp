// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstddef>

#include <Eigen/Core>

namespace tread::learner {

/// Scatter of the executions of each pattern about the known ground, on any ground: v_x, v_y and
/// omega of the mean twist, and additionally the end (an unsteady path ends elsewhere than a steady
/// one of the same mean twist).
struct Scatter {
  static constexpr Eigen::Index kQuantities = 4;
  using Factors = Eigen::Matrix<double, kQuantities, Eigen::Dynamic>;

  explicit Scatter(size_t patterns)
      : sums(Eigen::MatrixXd::Zero(1 + kQuantities, static_cast<Eigen::Index>(patterns))) {}

  /// Squared errors of an execution, divided by the ground model's variances.
  void add(size_t pattern, const Eigen::Vector4d& squared_error, double longest_memory);
  /// Expected factors on the variances, a column for each pattern: its mean, shrunk by `prior`
  /// executions towards that of all patterns, which is shrunk by as many towards 1.
  /** Rough ground does not predict the roughness of the next one: if the velocities of all patterns
   * together scatter more than expected, only the differences between patterns count. Otherwise
   * all grounds would look alike to a wide expectation; the roughness of each ground is its own q.
   */
  Factors expected(double prior) const;

  /// A column for each pattern: number of executions, then their squared errors
  Eigen::MatrixXd sums;
};

}  // namespace tread::learner
