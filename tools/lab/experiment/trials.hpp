// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <map>
#include <memory>
#include <optional>
#include <random>
#include <string>
#include <vector>

#include "common/pattern/pattern.hpp"
#include "common/recordings/recordings.hpp"
#include "common/vehicle/model.hpp"
#include "modules/learner/core/rules/learning_rule.hpp"
#include "modules/learner/core/scaling.hpp"
#include "tools/lab/experiment/methods.hpp"

namespace tread::experiment {

/// A random index below `count`, the same on every platform.
inline size_t drawIndex(std::mt19937_64& random, size_t count) {
  return static_cast<size_t>(((random() >> 32) * static_cast<uint64_t>(count)) >> 32);
}

/// A distinct seed for each combination of numbers (splitmix64 over all of them).
inline uint64_t seedOf(std::initializer_list<uint64_t> numbers) {
  uint64_t state = 0;
  for (const uint64_t number : numbers) {
    state += number + 0x9E3779B97F4A7C15ULL;
    state = (state ^ (state >> 30)) * 0xBF58476D1CE4E5B9ULL;
    state = (state ^ (state >> 27)) * 0x94D049BB133111EBULL;
    state ^= state >> 31;
  }
  return state;
}

/// The correct set from the beginning, without learning: column d of the paper's Table I.
inline constexpr const char* kOmniscient = "omniscient";

/// A value with its 99 % interval.
struct Estimate {
  double value = std::numeric_limits<double>::quiet_NaN();
  double low = std::numeric_limits<double>::quiet_NaN();
  double high = std::numeric_limits<double>::quiet_NaN();
};

/// Sums of the errors of methods and of the driven distance, over repetitions.
/** Repetitions that share an excitation run are dependent, so intervals are over runs: the sum over
 * the repetitions of a run is one sample, and Student's quantile is for the number of runs
 * [cluster-robust delta method]. They hold for new runs on the same recordings. All methods use
 * the same recordings, so products of their errors are kept: the interval of a reduction is that
 * of paired trials. */
class RatioMoments {
 public:
  explicit RatioMoments(size_t methods = 0)
      : size_(methods + 1), sums_(size_), squares_(size_), products_(size_ * size_) {}

  /// One repetition: metres or radians covered, and the summed error of each method.
  void add(double covered, const double* errors);
  /// All repetitions of another excitation run.
  void addRun(const RatioMoments& run);

  double repetitions() const { return repetitions_; }
  /// Sum of errors over sum of distance.
  Estimate error(size_t method) const { return quotient(method + 1, 0); }
  /// Ratio of the errors of two methods.
  Estimate ratio(size_t method, size_t other) const { return quotient(method + 1, other + 1); }
  /// Standard deviation of a repetition's error, relative to its mean distance.
  double deviation(size_t method) const;

 private:
  Estimate quotient(size_t above, size_t below) const;
  double product(size_t i, size_t j) const {
    return products_[i < j ? i * size_ + j : j * size_ + i];
  }

  size_t size_;
  double repetitions_ = 0.0;
  size_t runs_ = 0;
  std::vector<double> sums_;      ///< covered, then each method's errors
  std::vector<double> squares_;   ///< of repetitions
  std::vector<double> products_;  ///< of sums of runs, upper triangle
};

/// Histogram of errors with bins of equal width.
struct Histogram {
  double width = 1.0;
  std::vector<double> counts;

  void add(double value) {
    const double bin = value / width;
    if (bin < static_cast<double>(counts.size())) counts[static_cast<size_t>(bin)] += 1.0;
  }
  /// `other` has the same bins.
  void add(const Histogram& other) {
    for (size_t bin = 0; bin < counts.size(); ++bin) counts[bin] += other.counts[bin];
  }
};

/// Student's 99.5 % quantile for means of `samples` values.
double student99(size_t samples);

/// Errors of all rules, per driven metre and per turned radian.
struct MethodErrors {
  explicit MethodErrors(size_t rules = 0) : position(rules), orientation(rules) {}
  void addRun(const MethodErrors& run) {
    position.addRun(run.position);
    orientation.addRun(run.orientation);
  }
  RatioMoments position;     ///< [1] metres over metres of path
  RatioMoments orientation;  ///< [1] radians over radians of net yaw
};

/// Conditions of trials: old surface, new surface, number of repetitions.
struct TrialSite {
  const TrialGround& from;
  const TrialGround& to;
  bool change_inside = false;  ///< the first half of the first execution is on `from`
  int64_t repetitions = 0;
  uint64_t seed = 0;
};

/// Errors over the test sequences and their distribution, by rule.
struct SequenceErrors {
  MethodErrors errors;
  std::vector<Histogram> position;     ///< of single executions, per metre
  std::vector<Histogram> orientation;  ///< of single executions, per radian

  void addRun(const SequenceErrors& run) {
    errors.addRun(run.errors);
    for (size_t i = 0; i < position.size(); ++i) {
      position[i].add(run.position[i]);
      orientation[i].add(run.orientation[i]);
    }
  }
};

/// Section V: every sequence from the same initial state, prediction before learning. Each
/// repetition drives all sequences once; all rules use the same recordings.
SequenceErrors driveSequences(Methods& methods, const TrialSite& site,
                              const std::vector<Sequence>& sequences, Histogram position_bins,
                              Histogram orientation_bins);

/// Errors over ALL patterns on unused recordings, after each of some (ascending) numbers of
/// executions of a repeated sequence.
std::vector<MethodErrors> driveAllPatterns(Methods& methods, const TrialSite& site,
                                           const std::vector<Sequence>& sequences,
                                           const std::vector<int>& executions);

/// Errors of each of the first executions of the repeated first sequence, without a reset.
std::vector<MethodErrors> driveDevelopment(Methods& methods, const TrialSite& site,
                                           const std::vector<Sequence>& sequences,
                                           size_t executions);

/// Errors in the long run: repeated test sequences, or random patterns if there are none, without a
/// reset; the first executions do not count. A repetition is one such drive.
MethodErrors driveLong(Methods& methods, const TrialSite& site,
                       const std::vector<Sequence>& sequences);

/// Predicted width of a never executed pattern relative to its shipped width (sideways reach of its
/// end), before and after each execution of the test sequences on unchanged ground; by rule, means
/// over repetitions.
std::vector<std::vector<double>> driveDrift(Methods& methods, const TrialSite& site,
                                            const std::vector<Sequence>& sequences, size_t watched,
                                            size_t executions);

}  // namespace tread::experiment
