// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <array>
#include <string>
#include <vector>

#include "tools/lab/experiment/trials.hpp"

namespace tread::experiment {

/// Measured ends inside their predicted 90 % regions.
struct RegionCount {
  double ends = 0.0;  ///< with a stated region
  double inside = 0.0;

  void add(const RegionCount& other) {
    ends += other.ends;
    inside += other.inside;
  }
};

/// The first executions of random patterns on a surface.
struct FirstExecutions {
  static constexpr size_t kCount = 12;
  /// Numbers of executions after which all patterns are tested.
  static constexpr std::array<size_t, 6> kTested{0, 1, 2, 3, 5, 10};

  explicit FirstExecutions(size_t methods = 0)
      : all_patterns(kTested.size(), MethodErrors(methods)),
        regions(kCount, std::vector<RegionCount>(methods)) {}
  void addRun(const FirstExecutions& run);

  std::vector<MethodErrors> all_patterns;  ///< by kTested
  /// [execution][method], stated before the execution
  std::vector<std::vector<RegionCount>> regions;
};

/// Each repetition starts anew; all methods execute the same recordings.
FirstExecutions driveFirstExecutions(Methods& methods, const TrialSite& site);

struct Tables;
struct Setting;

}  // namespace tread::experiment
