// SPDX-License-Identifier: BSD-3-Clause
// Copyright (c) 2026 The Tread authors
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "tests/study/score/judgement.hpp"

namespace tread::blindtest {

/// A case with the score of its answer.
struct JudgedCase {
  CaseRecord record;
  Judgement judgement;
  double seconds = kUnknown;  ///< CPU time of the answer; NaN if not measured
};

/// Target of a figure, decided by its interval.
struct Must {
  double at = 0.0;
  bool least = true;                     ///< at least; else at most
  std::optional<double> below = {};      ///< also at most this
  std::optional<double> upper_end = {};  ///< the interval's upper end is at most this
  size_t cases = 0;                      ///< fewer are not sufficient
};

/// Whether what must be is reached.
enum class Met { kYes, kNo, kOpen };  ///< open: the interval contains the target

/// One figure with its 95 % interval: Wilson's for a share, order statistics for a quantile.
struct ScoreLine {
  std::string section;
  std::string what;
  bool is_share = true;
  const char* unit = "%";  ///< unit, unless it is a share: %, s
  size_t hits = 0;
  size_t cases = 0;
  double value = kUnknown;  ///< share of 1, or the figure; NaN without cases
  double low = kUnknown;
  double high = kUnknown;
  std::optional<Must> must = {};

  /// nullopt without cases or target. Shares that must be 0 or 1 are decided by the value.
  std::optional<Met> met() const;
  /// Whether the value, ignoring the interval, reaches the target.
  bool valueIsGood() const;
};

/// Wilson's 95 % interval of a share; sets value, low and high from hits and cases.
void setShare(ScoreLine& line);

/// The q-quantile by linear interpolation; NaN if empty.
double quantile(std::vector<double> values, double q);

/// Sets value, low and high of a quantile of values; the interval is distribution-free.
void setQuantile(ScoreLine& line, std::vector<double> values, double q);

/// All figures: first those with a target, then the details.
std::vector<ScoreLine> scoresOf(const std::vector<JudgedCase>& cases);

/// Names given to hidden effects, for single cases and null logs.
struct Confusion {
  std::vector<std::string> hidden;  ///< rows, sorted; "nothing" (null logs) last
  std::vector<std::string> named;   ///< columns: names, then "nothing", "unexplained", "refused"
  std::vector<std::vector<double>> share;  ///< of a row's cases
  std::vector<size_t> cases;               ///< per row
};

Confusion confusionOf(const std::vector<JudgedCase>& cases);

}  // namespace tread::blindtest
