// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstddef>
#include <limits>
#include <vector>

namespace tread::experiment {

/// A value with its 99 % interval.
struct Estimate {
  double value = std::numeric_limits<double>::quiet_NaN();
  double low = std::numeric_limits<double>::quiet_NaN();
  double high = std::numeric_limits<double>::quiet_NaN();
};

/// Sums of what rules erred and of what was covered meanwhile, over repetitions.
/** All rules see the same recordings, so that products of their errors are kept, too: the interval
 * of a reduction is that of paired trials. */
class RatioMoments {
 public:
  explicit RatioMoments(size_t rules = 0)
      : size_(rules + 1), sums_(size_), products_(size_ * size_) {}

  /// One repetition: metres or radians covered, and the summed error of each rule.
  void add(double covered, const double* errors);
  void add(const RatioMoments& other);

  double repetitions() const { return repetitions_; }
  /// Sum of errors over sum of what was covered; delta method over repetitions.
  Estimate error(size_t rule) const { return quotient(rule + 1, 0); }
  /// Error of a rule over that of another one.
  Estimate ratio(size_t rule, size_t other) const { return quotient(rule + 1, other + 1); }
  /// Standard deviation of a repetition's error, over the mean of what one covers.
  double deviation(size_t rule) const;

 private:
  Estimate quotient(size_t above, size_t below) const;
  double product(size_t i, size_t j) const {
    return products_[i < j ? i * size_ + j : j * size_ + i];
  }

  size_t size_;
  double repetitions_ = 0.0;
  std::vector<double> sums_;      ///< covered, then each rule's errors
  std::vector<double> products_;  ///< upper triangle of their products
};

/// How often errors fell into each of some bins of equal width.
struct Histogram {
  double width = 1.0;
  std::vector<double> counts;

  void add(double value) {
    const double bin = value / width;
    if (bin < static_cast<double>(counts.size())) counts[static_cast<size_t>(bin)] += 1.0;
  }
  /// Of equal bins.
  void add(const Histogram& other) {
    for (size_t bin = 0; bin < counts.size(); ++bin) counts[bin] += other.counts[bin];
  }
};

/// Standard normal and Student's 99.5 % quantile; the second for means of `samples` values.
inline constexpr double kNormal99 = 2.5758293035489;
double student99(size_t samples);

}  // namespace tread::experiment
