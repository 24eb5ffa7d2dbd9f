// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "common/recordings/robust_fit.hpp"

#include <algorithm>
#include <cmath>

#include <Eigen/QR>

namespace tread::drive_patterns {
namespace {

constexpr int kIterations = 30;
constexpr double kHuber = 1.345;        // 95 % efficient where the errors are normal
constexpr double kMadToSigma = 1.4826;  // of a normal distribution

/// Length of each observation's residual, per row.
Eigen::VectorXd lengths(const Eigen::VectorXd& residuals, int group) {
  const Eigen::Index count = residuals.size() / group;
  Eigen::VectorXd result(count);
  for (Eigen::Index i = 0; i < count; ++i)
    result[i] = residuals.segment(i * group, group).norm() / std::sqrt(group);
  return result;
}

double scaleOf(const Eigen::VectorXd& length, const Eigen::VectorXd& prior, double least) {
  Eigen::VectorXd counted(length.size());
  Eigen::Index n = 0;
  for (Eigen::Index i = 0; i < length.size(); ++i)
    if (prior[i] > 0.0) counted[n++] = length[i];
  return std::max(least, kMadToSigma * medianOf(counted.head(n)));
}

}  // namespace

double medianOf(Eigen::VectorXd values) {
  if (values.size() == 0) return 0.0;
  std::sort(values.data(), values.data() + values.size());
  const Eigen::Index half = values.size() / 2;
  return values.size() % 2 == 1 ? values[half] : 0.5 * (values[half - 1] + values[half]);
}

Eigen::VectorXd huberFit(const Eigen::MatrixXd& A, const Eigen::VectorXd& b,
                         const Eigen::VectorXd& prior, const HuberLimits& limits) {
  Eigen::VectorXd weight = prior;
  Eigen::VectorXd x;
  for (int iteration = 0; iteration < kIterations; ++iteration) {
    Eigen::VectorXd root(A.rows());
    for (Eigen::Index row = 0; row < A.rows(); ++row)
      root[row] = std::sqrt(weight[row / limits.group]);
    x = (root.asDiagonal() * A).colPivHouseholderQr().solve(root.cwiseProduct(b));
    const Eigen::VectorXd length = lengths(A * x - b, limits.group);
    const double bound = kHuber * scaleOf(length, prior, limits.least_scale);
    for (Eigen::Index i = 0; i < weight.size(); ++i)
      weight[i] = prior[i] * (length[i] > bound ? bound / length[i] : 1.0);
  }
  return x;
}

}  // namespace tread::drive_patterns
