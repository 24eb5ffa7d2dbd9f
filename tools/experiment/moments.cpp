// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#include "tools/experiment/moments.hpp"

#include <algorithm>
#include <cmath>

namespace tread::experiment {

void RatioMoments::add(double covered, const double* errors) {
  repetitions_ += 1.0;
  sums_[0] += covered;
  products_[0] += covered * covered;
  for (size_t j = 1; j < size_; ++j) products_[j] += covered * errors[j - 1];
  for (size_t i = 1; i < size_; ++i) {
    sums_[i] += errors[i - 1];
    double* row = products_.data() + i * size_;
    for (size_t j = i; j < size_; ++j) row[j] += errors[i - 1] * errors[j - 1];
  }
}

void RatioMoments::add(const RatioMoments& other) {
  repetitions_ += other.repetitions_;
  for (size_t i = 0; i < sums_.size(); ++i) sums_[i] += other.sums_[i];
  for (size_t i = 0; i < products_.size(); ++i) products_[i] += other.products_[i];
}

Estimate RatioMoments::quotient(size_t above, size_t below) const {
  // Var(A/B) = sum((a - r b)^2) / (sum b)^2, the delta method.
  const double ratio = sums_[above] / sums_[below];
  const double squares = product(above, above) - 2.0 * ratio * product(above, below) +
                         ratio * ratio * product(below, below);
  const double n = repetitions_;
  const double variance =
      std::max(0.0, squares) / (sums_[below] * sums_[below]) * (n > 1.0 ? n / (n - 1.0) : 1.0);
  const double half = kNormal99 * std::sqrt(variance);
  return {ratio, ratio - half, ratio + half};
}

double RatioMoments::deviation(size_t rule) const {
  const double mean = sums_[rule + 1] / repetitions_;
  const double square = product(rule + 1, rule + 1) / repetitions_;
  return std::sqrt(std::max(0.0, square - mean * mean)) / (sums_[0] / repetitions_);
}

double student99(size_t samples) {
  constexpr double kQuantiles[] = {63.657, 9.925, 5.841, 4.604, 4.032, 3.707, 3.499, 3.355,
                                   3.250,  3.169, 3.106, 3.055, 3.012, 2.977, 2.947, 2.921,
                                   2.898,  2.878, 2.861, 2.845, 2.831, 2.819, 2.807, 2.797,
                                   2.787,  2.779, 2.771, 2.763, 2.756};
  constexpr size_t kListed = sizeof kQuantiles / sizeof kQuantiles[0];
  if (samples < 2) return std::numeric_limits<double>::infinity();
  if (samples - 2 < kListed) return kQuantiles[samples - 2];
  // Two terms of the expansion about the normal quantile: exact to 0.002 from here on.
  const double freedom = static_cast<double>(samples - 1);
  return kNormal99 + (std::pow(kNormal99, 3) + kNormal99) / (4.0 * freedom);
}

}  // namespace tread::experiment
