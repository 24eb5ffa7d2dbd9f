// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "modules/learner/core/rules/scatter.hpp"

#include <cmath>

#include "modules/learner/core/rules/surface.hpp"

namespace tread::learner {
namespace {

/// Resolution of factors, which limits their digits in the state file [1].
constexpr double kFactorStep = 1e-3;

}  // namespace

void Scatter::add(size_t pattern, const Eigen::Vector4d& squared_error, double longest_memory) {
  auto of_pattern = sums.col(static_cast<Eigen::Index>(pattern));
  of_pattern[0] += 1.0;
  of_pattern.tail<kQuantities>() += squared_error;
  const double count = sums.row(0).sum();
  if (count > longest_memory) sums *= longest_memory / count;
}

Scatter::Factors Scatter::expected(double prior) const {
  const Eigen::VectorXd all = sums.rowwise().sum();
  const Eigen::Array4d mean = (prior + all.tail<kQuantities>().array()) / (prior + all[0]);
  Factors factors(kQuantities, sums.cols());
  for (Eigen::Index p = 0; p < sums.cols(); ++p) {
    Eigen::Array4d own =
        (prior * mean + sums.col(p).tail<kQuantities>().array()) / (prior + sums(0, p));
    own.head<3>() /= mean.head<3>().max(1.0);
    factors.col(p) = own.max(kLeastNoise).min(kMostNoise).unaryExpr([](double factor) {
      return kFactorStep * std::round(factor / kFactorStep);
    });
  }
  return factors;
}

}  // namespace tread::learner
