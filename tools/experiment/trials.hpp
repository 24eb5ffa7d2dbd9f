// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <limits>
#include <vector>

#include "tools/experiment/methods.hpp"

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

/// Patterns by index, one after the other.
using Sequence = std::vector<size_t>;

/// Errors of all rules: per driven metre and per radian turned.
struct Errors {
  explicit Errors(size_t rules = 0) : position(rules), orientation(rules) {}
  void add(const Errors& other) {
    position.add(other.position);
    orientation.add(other.orientation);
  }
  RatioMoments position;     ///< [1] metres over metres of path
  RatioMoments orientation;  ///< [1] radians over radians of net yaw
};

/// Where trials happen: the surface left behind, the one that is driven on, and how often.
struct TrialSite {
  const Ground& from;
  const Ground& to;
  bool change_inside = false;  ///< the first execution drives its first half on `from`
  int64_t repetitions = 0;
  uint64_t seed = 0;
};

/// Errors over the test sequences and how they are distributed, by rule.
struct SequenceErrors {
  Errors errors;
  std::vector<Histogram> position;     ///< of single executions, per metre of each
  std::vector<Histogram> orientation;  ///< per radian

  void add(const SequenceErrors& other) {
    errors.add(other.errors);
    for (size_t i = 0; i < position.size(); ++i) {
      position[i].add(other.position[i]);
      orientation[i].add(other.orientation[i]);
    }
  }
};

/// Section V: every sequence from the same beginning, prediction before learning. Each repetition
/// drives all sequences once; all rules see the same recordings.
SequenceErrors driveSequences(Methods& methods, const TrialSite& site,
                              const std::vector<Sequence>& sequences, Histogram position_bins,
                              Histogram orientation_bins);

/// Errors over ALL patterns on fresh recordings, after each of some numbers of executions of a
/// sequence continued (ascending).
std::vector<Errors> driveAllPatterns(Methods& methods, const TrialSite& site,
                                     const std::vector<Sequence>& sequences,
                                     const std::vector<int>& executions);

/// Errors of each of the first executions of the first sequence continued, without a reset.
std::vector<Errors> driveDevelopment(Methods& methods, const TrialSite& site,
                                     const std::vector<Sequence>& sequences, size_t executions);

/// Errors in the long run: the test sequences again and again, random patterns if there are none,
/// without a reset; the first executions do not count. A repetition is one such drive.
Errors driveLong(Methods& methods, const TrialSite& site, const std::vector<Sequence>& sequences);

/// How wide a pattern that is never executed is predicted, over its shipped width (sideways reach
/// of its end), before and after each execution of the test sequences on unchanged ground; by rule,
/// means over repetitions.
std::vector<std::vector<double>> driveDrift(Methods& methods, const TrialSite& site,
                                            const std::vector<Sequence>& sequences, size_t watched,
                                            size_t executions);

}  // namespace tread::experiment
