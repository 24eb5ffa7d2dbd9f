// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstdint>
#include <vector>

#include "tools/experiment/methods.hpp"
#include "tools/experiment/moments.hpp"

namespace tread::experiment {

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
