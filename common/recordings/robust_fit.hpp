// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <Eigen/Core>

namespace tread::drive_patterns {

/// How a robust fit weighs its rows.
struct HuberLimits {
  int group = 1;             ///< so many neighbouring rows belong to one observation
  double least_scale = 0.0;  ///< [unit of b] smaller residuals are never called large
};

/// x that minimises the sum of rho(|A x - b| per observation), rho of Huber (k = 1.345 scales).
/** Solved by iteratively reweighted least squares (QR); the scale is 1.4826 times the median of the
 * residuals' lengths per row, at least `least_scale`. `prior` holds a weight for each observation;
 * those of zero do not count. Deterministic. */
Eigen::VectorXd huberFit(const Eigen::MatrixXd& A, const Eigen::VectorXd& b,
                         const Eigen::VectorXd& prior, const HuberLimits& limits);

/// Median of the entries; 0 if there are none.
double medianOf(Eigen::VectorXd values);

}  // namespace tread::drive_patterns
